/**
 * How faces look: matte, lit from the upper left as in the service's pictures, with borders between parts, patches and
 * faces drawn within the faces themselves. So colours, borders and highlights change without new geometry.
 */

/** Texels to a row of the texture of face states. */
export const STATES_WIDTH = 512;

/** Corner k of face f is vertex 3f + k: that is all a vertex needs to know to find its face. */
export const VERTEX_SHADER = /* glsl */ `
uniform sampler2D uFaces;
flat out vec4 vState;
out vec3 vBarycentric;
out vec3 vPoint;
out vec3 vNormal;
out vec3 vEye;

void main() {
  int face = gl_VertexID / 3;
  int corner = gl_VertexID - 3 * face;
  vState = texelFetch(uFaces, ivec2(face % ${STATES_WIDTH}, face / ${STATES_WIDTH}), 0);
  vBarycentric = vec3(corner == 0, corner == 1, corner == 2);
  vPoint = position;
  vec4 eye = modelViewMatrix * vec4(position, 1.0);
  vEye = eye.xyz;
  vNormal = normalMatrix * normal.xyz;
  gl_Position = projectionMatrix * eye;
}
`;

export const FRAGMENT_SHADER = /* glsl */ `
uniform vec3 uUp; // of the shape, as the camera sees it
uniform float uPixel; // pixels of the screen to one of CSS
uniform vec3 uHighlight;
uniform float uWireframe;
uniform vec3 uBrushPoint;
uniform float uBrushRadius; // 0: no brush
flat in vec4 vState;
in vec3 vBarycentric;
in vec3 vPoint;
in vec3 vNormal;
in vec3 vEye;
out vec4 colour;

const vec3 KEY = vec3(-0.4357, 0.7261, 0.5325);

vec3 linear(vec3 srgb) { return pow(srgb, vec3(2.2)); }

// How much of a pixel a line of this width covers, whose middle is so many pixels away.
float line(float away, float width) { return clamp(0.5 * width + 0.5 - away, 0.0, 1.0); }

float anyOf(vec3 lines, uint bits) {
  vec3 isOn = vec3(float(bits & 1u), float((bits >> 1) & 1u), float((bits >> 2) & 1u));
  vec3 covered = lines * isOn;
  return max(covered.x, max(covered.y, covered.z));
}

float light(vec3 normal) {
  float direct = max(dot(normal, KEY), 0.0);
  float sky = mix(0.26, 0.52, 0.5 + 0.5 * dot(normal, uUp));
  float fill = 0.16 * max(dot(normal, vec3(0.62, -0.1, 0.78)), 0.0);
  float away = 1.0 - clamp(dot(normal, normalize(-vEye)), 0.0, 1.0);
  return (0.66 * direct + sky + fill) * (1.0 - 0.4 * away * away * away);
}

void main() {
  vec3 normal = normalize(vNormal) * (gl_FrontFacing ? 1.0 : -1.0);
  uint bits = uint(vState.a * 255.0 + 0.5);
  vec3 base = linear(vState.rgb);
  bool isHighlighted = (bits & 64u) != 0u;
  if (isHighlighted) base = mix(base, linear(uHighlight), 0.6) * 1.12 + 0.015;

  vec3 shaded = base * light(normal);

  // Edge k is opposite to corner k + 2; its line lies half in each of its two faces.
  vec3 slope = vec3(length(vec2(dFdx(vBarycentric.x), dFdy(vBarycentric.x))),
                    length(vec2(dFdx(vBarycentric.y), dFdy(vBarycentric.y))),
                    length(vec2(dFdx(vBarycentric.z), dFdy(vBarycentric.z))));
  vec3 away = (vBarycentric / max(slope, 1e-6)).zxy / uPixel;
  vec3 fine = vec3(line(away.x, 1.0), line(away.y, 1.0), line(away.z, 1.0));
  vec3 bold = vec3(line(away.x, 1.8), line(away.y, 1.8), line(away.z, 1.8));
  shaded *= 1.0 - 0.22 * uWireframe * max(fine.x, max(fine.y, fine.z));
  shaded *= 1.0 - 0.42 * anyOf(fine, (bits >> 3) & 7u);
  shaded *= 1.0 - 0.72 * anyOf(bold, bits & 7u);

  if (uBrushRadius > 0.0) {
    float distance = length(vPoint - uBrushPoint) - uBrushRadius;
    float pixels = abs(distance) / max(length(vec2(dFdx(distance), dFdy(distance))), 1e-9) / uPixel;
    shaded = mix(shaded, vec3(0.0), 0.55 * line(pixels, 4.0));
    shaded = mix(shaded, vec3(1.0), line(pixels, 1.6));
  }
  colour = vec4(pow(clamp(shaded, 0.0, 1.0), vec3(1.0 / 2.2)), 1.0);
}
`;
