/**
 * How faces look: matte, lit from the upper left as in the service's pictures, with borders between parts, patches and
 * faces drawn within the faces themselves. So colours, borders and highlights change without new geometry.
 */

/** Texels to a row of the texture of face states. */
export const STATES_WIDTH = 512;

/**
 * Corner k of face f is vertex 3f + k: that is all a vertex needs to know to find its face. What is the same all over a
 * face is worked out here, because without a graphics card pixels are dear. Squares and roots stand for the sRGB curve.
 */
export const VERTEX_SHADER = /* glsl */ `
uniform sampler2D uFaces;
uniform vec3 uHighlight;
flat out vec3 vColour; // linear
flat out uint vBits;
out vec2 vBarycentric; // of corners 0 and 1
out vec3 vPoint;
out vec3 vNormal;

void main() {
  int face = gl_VertexID / 3;
  int corner = gl_VertexID - 3 * face;
  vec4 state = texelFetch(uFaces, ivec2(face % ${STATES_WIDTH}, face / ${STATES_WIDTH}), 0);
  vBits = uint(state.a * 255.0 + 0.5);
  vColour = state.rgb * state.rgb;
  if ((vBits & 64u) != 0u) vColour = mix(vColour, uHighlight * uHighlight, 0.75) * 1.1 + 0.015;
  vBarycentric = vec2(corner == 0, corner == 1);
  vPoint = position;
  vNormal = normalMatrix * normal.xyz;
  gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));
}
`;

export const FRAGMENT_SHADER = /* glsl */ `
uniform vec3 uUp; // of the shape, as the camera sees it
uniform float uPixel; // pixels of the screen to one of CSS
uniform bool uWireframe;
uniform vec3 uBrushPoint;
uniform float uBrushRadius; // 0: no brush
flat in vec3 vColour;
flat in uint vBits;
in vec2 vBarycentric;
in vec3 vPoint;
in vec3 vNormal;
out vec4 colour;

const vec3 KEY = vec3(-0.4357, 0.7261, 0.5325);
const vec3 FILL = vec3(0.62, -0.1, 0.78);

// How much of a pixel a line of this width covers, whose middle is so many pixels away.
float line(float away, float width) { return clamp(0.5 * width + 0.5 - away, 0.0, 1.0); }

float nearest(vec3 away, uint bits) {
  return min((bits & 1u) != 0u ? away.x : 1e3, min((bits & 2u) != 0u ? away.y : 1e3, (bits & 4u) != 0u ? away.z : 1e3));
}

// The lens is long, so the camera is taken to be in front of every point alike.
float light(vec3 normal) {
  float direct = max(dot(normal, KEY), 0.0);
  float sky = 0.39 + 0.13 * dot(normal, uUp);
  float fill = 0.16 * max(dot(normal, FILL), 0.0);
  float away = 1.0 - max(normal.z, 0.0);
  return (0.66 * direct + sky + fill) * (1.0 - 0.4 * away * away * away);
}

void main() {
  vec3 normal = normalize(gl_FrontFacing ? vNormal : -vNormal);
  vec3 shaded = vColour * light(normal);

  if (uWireframe || (vBits & 63u) != 0u) {
    // Edge k is opposite to corner k + 2; its line lies half in each of its two faces.
    vec3 inside = vec3(1.0 - vBarycentric.x - vBarycentric.y, vBarycentric);
    vec3 along = dFdx(inside);
    vec3 down = dFdy(inside);
    vec3 away = inside * inversesqrt(max(along * along + down * down, 1e-12)) / uPixel;
    if (uWireframe) shaded *= 1.0 - 0.22 * line(nearest(away, 7u), 1.0);
    shaded *= 1.0 - 0.42 * line(nearest(away, vBits >> 3), 1.0);
    shaded *= 1.0 - 0.72 * line(nearest(away, vBits), 1.8);
  }
  if (uBrushRadius > 0.0) {
    float distance = length(vPoint - uBrushPoint) - uBrushRadius;
    float pixels = abs(distance) / max(length(vec2(dFdx(distance), dFdy(distance))), 1e-9) / uPixel;
    shaded = mix(shaded, vec3(0.0), 0.55 * line(pixels, 4.0));
    shaded = mix(shaded, vec3(1.0), line(pixels, 1.6));
  }
  colour = vec4(sqrt(shaded), 1.0);
}
`;
