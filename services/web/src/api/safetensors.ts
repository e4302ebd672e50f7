/** Reads safetensors: a length (u64), a JSON header, then the arrays' bytes. https://github.com/huggingface/safetensors */

const VIEWS = {
  U8: Uint8Array,
  U16: Uint16Array,
  U32: Uint32Array,
  I32: Int32Array,
  F32: Float32Array,
  F64: Float64Array,
} as const;

type Dtype = keyof typeof VIEWS;
export type TypedArray = InstanceType<(typeof VIEWS)[Dtype]>;

export interface NamedArray {
  readonly shape: readonly number[];
  readonly values: TypedArray;
}

export interface Arrays {
  readonly arrays: Readonly<Record<string, NamedArray>>;
  readonly metadata: Readonly<Record<string, string>>;
}

interface Entry {
  dtype: string;
  shape: number[];
  data_offsets: [number, number];
}

const LENGTH_BYTES = 8;

/** The arrays of a file. Views of `buffer` where their alignment allows it, copies where not. */
export function parseSafetensors(buffer: ArrayBuffer): Arrays {
  const headerBytes = Number(new DataView(buffer).getBigUint64(0, true));
  const start = LENGTH_BYTES + headerBytes;
  if (start > buffer.byteLength)
    throw new RangeError(`a header of ${headerBytes} bytes passes the file's end`);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, LENGTH_BYTES, headerBytes)));
  const { __metadata__: metadata = {}, ...entries } = header as Record<string, Entry> & {
    __metadata__?: Record<string, string>;
  };
  const arrays: Record<string, NamedArray> = {};
  for (const [name, entry] of Object.entries(entries as Record<string, Entry>)) {
    arrays[name] = { shape: entry.shape, values: viewOf(buffer, start, name, entry) };
  }
  return { arrays, metadata };
}

function viewOf(buffer: ArrayBuffer, start: number, name: string, entry: Entry): TypedArray {
  if (!(entry.dtype in VIEWS))
    throw new TypeError(`array ${name} is of type ${entry.dtype}, which is not read here`);
  const View = VIEWS[entry.dtype as Dtype];
  const [from, to] = entry.data_offsets;
  const begin = start + from;
  const isAligned = begin % View.BYTES_PER_ELEMENT === 0;
  const bytes = isAligned ? buffer : buffer.slice(begin, start + to);
  return new View(bytes, isAligned ? begin : 0, (to - from) / View.BYTES_PER_ELEMENT);
}

/** An array that must be there, and of this kind. */
export function arrayOf<T extends TypedArray>(
  file: Arrays,
  name: string,
  kind: new (length: number) => T,
): T {
  const found = file.arrays[name]?.values;
  if (!(found instanceof kind))
    throw new TypeError(`the service's answer has no array ${name} of ${kind.name}`);
  return found;
}
