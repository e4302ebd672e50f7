/** The graphics context, and how fine a picture it can afford. */
import { WebGLRenderer } from "three";

/** This browser shows no WebGL 2. The message is for people. */
export class NoWebGlError extends Error {
  override readonly name = "NoWebGlError";
}

export interface Graphics {
  readonly renderer: WebGLRenderer;
  /** Drawn by the processor, without a graphics card: every pixel counts. */
  readonly isSoftware: boolean;
}

/** Throws NoWebGlError. */
export function newGraphics(canvas: HTMLCanvasElement): Graphics {
  try {
    const context = newContext(canvas);
    const renderer = new WebGLRenderer({ canvas, context });
    renderer.autoClear = false;
    renderer.setClearAlpha(0);
    renderer.setScissorTest(true);
    return { renderer, isSoftware: isDrawnByProcessor(context) };
  } catch {
    throw new NoWebGlError(
      "This browser does not show 3D. Turn on hardware acceleration in its settings, or use another browser.",
    );
  }
}

/** Smooth edges, but not where the processor draws: they would cost several times as much. */
function newContext(canvas: HTMLCanvasElement): WebGL2RenderingContext {
  const wish = { alpha: true, powerPreference: "high-performance" } as const;
  const context =
    canvas.getContext("webgl2", { ...wish, antialias: true, failIfMajorPerformanceCaveat: true }) ??
    canvas.getContext("webgl2", { ...wish, antialias: false });
  if (context === null) throw new NoWebGlError("no WebGL 2");
  return context;
}

function isDrawnByProcessor(gl: WebGL2RenderingContext): boolean {
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(names?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER));
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}
