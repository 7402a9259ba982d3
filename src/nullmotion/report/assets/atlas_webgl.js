// Draws ordered triangles with the graphics card; null where there is none worth the name.
const ANCHORS = 17; // colours of a scale
const VERTEX_SHADER = `#version 300 es
in vec3 place; in vec3 normal; in float kind; in float level;
uniform vec3 right, up, towards; uniform vec2 half_size; uniform float size, far;
out vec3 at; out vec3 n; out float left; flat out int what;
void main() {
  at = place; n = normal; left = level; what = int(kind + .5);
  float f = size * far / (far - dot(towards, place));
  gl_Position = vec4(f * dot(right, place) / half_size.x, f * dot(up, place) / half_size.y, 0., 1.);
}`;
const FRAGMENT_SHADER = `#version 300 es
precision highp float;
in vec3 at; in vec3 n; in float left; flat in int what;
uniform vec3 towards, light, stripe_axis; uniform vec4 plane; uniform vec4 look[8]; uniform vec2 edge[8]; uniform bool ramped; uniform vec3 ramp[${ANCHORS}];
out vec4 colour;
void main() {
  if (dot(plane.xyz, at) > plane.w) discard;
  vec3 m = normalize(n); float turned = dot(m, towards) < 0. ? -1. : 1.;
  float shade = .7 + .3 * turned * dot(m, light);
  vec4 paint = look[what]; vec2 extra = edge[what];
  float alpha = paint.a + (1. - paint.a) * extra.x * pow(1. - abs(dot(m, towards)), 3.);
  vec3 rgb = paint.rgb;
  if (ramped) {
    float s = clamp(left, 0., 1.) * ${ANCHORS - 1}.; int k = min(int(s), ${ANCHORS - 2});
    rgb = mix(ramp[k], ramp[k + 1], s - float(k));
  }
  rgb *= clamp(shade, 0., 1.);
  if (extra.y > 0.) {
    float s = dot(stripe_axis, at);
    float wide = max(fwidth(s), 1e-6);
    float dark = smoothstep(.2 + wide, .2, fract(s)) * smoothstep(-wide, 0., fract(s)) * clamp(.25 / wide, 0., 1.);
    rgb *= 1. - .41 * dark; alpha = min(1., alpha + .2 * dark);
  }
  colour = vec4(rgb * alpha, alpha);
}`;

// Whether there is no card, or one that the processor plays: then drawing there ourselves is as fast.
function emulated() {
  const probe = document.createElement("canvas").getContext("webgl2", { failIfMajorPerformanceCaveat: true });
  if (!probe) return true;
  const name = probe.getParameter(probe.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? probe.RENDERER);
  probe.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

function webgl(canvas) {
  if (location.hash !== "#webgl" && emulated()) return null;
  const gl = canvas.getContext("webgl2", { antialias: true, premultipliedAlpha: true, depth: false });
  if (!gl) return null;
  const program = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, VERTEX_SHADER], [gl.FRAGMENT_SHADER, FRAGMENT_SHADER]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return null;
  gl.useProgram(program);

  const attribute = (name, size) => {
    const where = gl.getAttribLocation(program, name), buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(where);
    gl.vertexAttribPointer(where, size, gl.FLOAT, false, 0, 0);
    return (values) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, Float32Array.from(values), gl.STATIC_DRAW);
    };
  };
  const put = { place: attribute("place", 3), normal: attribute("normal", 3), kind: attribute("kind", 1), level: attribute("level", 1) };
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  const set = (name) => gl.getUniformLocation(program, name);
  let loaded = null, corners = null, indices = null;

  // A triangle's type goes with its corners, so a corner of two types is there twice.
  function load(surface) {
    const { corner, kind, place, normal, level, count } = surface;
    const twin = new Map(), places = [], normals = [], kinds = [], levels = [];
    [loaded, corners, indices] = [surface, new Uint32Array(corner.length), new Uint32Array(corner.length)];
    for (let i = 0; i < 3 * count; i += 1) {
      const t = Math.floor(i / 3), key = corner[i] * 8 + kind[t];
      if (!twin.has(key)) {
        const v = 3 * corner[i];
        twin.set(key, kinds.length);
        places.push(place[v], place[v + 1], place[v + 2]);
        normals.push(normal[v], normal[v + 1], normal[v + 2]);
        kinds.push(kind[t]);
        levels.push(level[corner[i]] / 255);
      }
      corners[i] = twin.get(key);
    }
    put.place(places);
    put.normal(normals);
    put.kind(kinds);
    put.level(levels);
  }

  return {
    name: "webgl",
    draw(surface, order, view, style, plane) {
      if (surface !== loaded) load(surface);
      const density = Math.max(1, devicePixelRatio);
      const [w, h] = [Math.round(view.width * density), Math.round(view.height * density)];
      if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
      order.forEach((t, i) => indices.set(corners.subarray(3 * t, 3 * t + 3), 3 * i));
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices.subarray(0, 3 * order.length), gl.DYNAMIC_DRAW);
      gl.viewport(0, 0, w, h);
      gl.clearColor(0, 0, 0, 0);
      gl.clear(gl.COLOR_BUFFER_BIT);
      for (const name of ["right", "up", "towards"]) gl.uniform3fv(set(name), view[name]);
      gl.uniform3fv(set("light"), style.light(view));
      gl.uniform3fv(set("stripe_axis"), style.stripeAxis);
      gl.uniform2f(set("half_size"), view.width / 2, view.height / 2);
      gl.uniform1f(set("size"), view.size);
      gl.uniform1f(set("far"), view.far);
      gl.uniform4fv(set("plane"), plane ? [...plane.normal, plane.offset] : [0, 0, 0, 1]);
      gl.uniform4fv(set("look"), style.kinds.flatMap((k) => [...k.rgb.map((c) => c / 255), k.alpha]));
      gl.uniform1i(set("ramped"), style.ramp ? 1 : 0);
      gl.uniform3fv(set("ramp"), style.anchors.flat().map((c) => c / 255));
      gl.uniform2fv(set("edge"), style.kinds.flatMap((k) => [k.rim, k.stripes ? 1 : 0]));
      gl.drawElements(gl.TRIANGLES, 3 * order.length, gl.UNSIGNED_INT, 0);
      return 0;
    },
  };
}
