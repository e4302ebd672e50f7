/** The graphics context, and how fine a picture it can afford. */
import { WebGLRenderer } from "three";

/** This browser shows no WebGL 2. The message is for people. */
export class NoWebGlError extends Error {
  override readonly name = "NoWebGlError";
}

export interface Graphics {
  readonly renderer: WebGLRenderer;
  /** Drawn by the processor, without a graphics card: every pixel counts. What was drawn stays, to be drawn on. */
  readonly isSoftware: boolean;
}

/** Throws NoWebGlError. */
export function newGraphics(canvas: HTMLCanvasElement): Graphics {
  try {
    const isSoftware = isDrawnByProcessor();
    const renderer = new WebGLRenderer({
      canvas,
      antialias: !isSoftware,
      preserveDrawingBuffer: isSoftware,
      alpha: true,
      powerPreference: "high-performance",
    });
    renderer.autoClear = false;
    renderer.setClearAlpha(0);
    renderer.setScissorTest(true);
    return { renderer, isSoftware };
  } catch {
    throw new NoWebGlError(
      "This browser does not show 3D. Turn on hardware acceleration in its settings, or use another browser.",
    );
  }
}

/** Asked of a context of its own, because smoothing is chosen when a context is made. */
function isDrawnByProcessor(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (gl === null) throw new NoWebGlError("no WebGL 2");
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(names?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER));
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}
