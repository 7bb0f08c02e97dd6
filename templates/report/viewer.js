// A viewer of the robot in WebGL 2: opaque and see-through surfaces, a floor, a camera to turn.

const FIELD_OF_VIEW = 0.6;            // from top to bottom [rad]
const CREASE = Math.cos(0.6);         // faces that meet at more than this have an edge [rad]
const ALIKE = 0.999;                  // cosine between normals that are one
const SLOW = 40, COARSEST = 0.4;      // [ms] from picture to picture at which it is drawn coarser; by how much at most
const TILES = 9;                      // of the floor to either side
const REST = 200;                     // [ms] without any motion after which it is drawn finely

// Lit at the corners and not at every pixel: where a processor draws, that takes a fifth off a picture.
const SURFACE_VERTEX = `#version 300 es
in vec3 place, normal; uniform mat4 view, world; uniform vec4 color; uniform vec3 eye, light; out vec4 lit;
void main() { vec4 at = world * vec4(place, 1.0); gl_Position = view * at;
  vec3 to = normalize(eye - at.xyz), m = mat3(world) * normal; if (dot(m, to) < 0.0) m = -m;
  float sky = 0.5 + 0.5 * m.z, key = max(dot(m, light), 0.0);
  float gloss = pow(max(dot(m, normalize(light + to)), 0.0), 32.0);
  lit = vec4(min(color.rgb * (0.34 + 0.22 * sky + 0.52 * key) + 0.10 * gloss, 1.0) * color.a, color.a); }`;
const SURFACE_FRAGMENT = `#version 300 es
precision mediump float; in vec4 lit; out vec4 shown; void main() { shown = lit; }`;
const FLOOR_VERTEX = `#version 300 es
in vec3 place; uniform mat4 view; uniform vec3 middle; uniform float tile, reach; out float alpha;
void main() { vec2 p = (place.xy + floor(middle.xy / tile + 0.5)) * tile;
  alpha = 0.4 * (1.0 - smoothstep(0.2, 1.0, length(p - middle.xy) / reach)); gl_Position = view * vec4(p, middle.z, 1.0); }`;
const FLOOR_FRAGMENT = `#version 300 es
precision mediump float; in float alpha; uniform vec3 ink; out vec4 shown; void main() { shown = vec4(ink * alpha, alpha); }`;

// Matrices are sixteen numbers, column by column; quaternions are w, x, y, z.
const times = (a, b) => {
  const c = new Float32Array(16);
  for (let j = 0; j < 4; j++) for (let i = 0; i < 4; i++)
    c[4 * j + i] = a[i] * b[4 * j] + a[4 + i] * b[4 * j + 1] + a[8 + i] * b[4 * j + 2] + a[12 + i] * b[4 * j + 3];
  return c;
};
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const inner = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const unit = (a) => { const l = Math.hypot(...a) || 1; return a.map((x) => x / l); };

function placed([w, x, y, z], [px, py, pz]) {
  return new Float32Array([
    1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y), 0,
    2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x), 0,
    2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y), 0,
    px, py, pz, 1]);
}

function spun([w, x, y, z], angle) {
  const c = Math.cos(angle / 2), s = Math.sin(angle / 2);
  return [w * c - z * s, x * c + y * s, y * c - x * s, z * c + w * s];
}

function seenFrom(eye, target, aspect, near, far) {
  const back = unit(minus(eye, target)), right = unit(cross([0, 0, 1], back)), up = cross(back, right);
  const f = 1 / Math.tan(FIELD_OF_VIEW / 2), d = near - far;
  const look = new Float32Array([
    right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
    -inner(right, eye), -inner(up, eye), -inner(back, eye), 1]);
  return times(new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (near + far) / d, -1, 0, 0, 2 * near * far / d, 0]), look);
}

// The numbers that Python packed: zlib in base64, cut into arrays where `scene` says.
async function unpacked(text) {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = await new Response(stream).arrayBuffer();
  const kinds = { f4: Float32Array, i2: Int16Array, u2: Uint16Array, u4: Uint32Array };
  return ({ at, kind, length }) => new kinds[kind](bytes, at, length);
}

// Corners with normals that are smooth but for edges, and the three of each face.
function shaded(surface, array) {
  const parts = array(surface.vertices), faces = array(surface.faces), count = faces.length / 3;
  const points = Float32Array.from(parts, (part, i) => surface.low[i % 3] + part / 65535 * surface.size[i % 3]);
  const corner = (i) => [points[3 * i], points[3 * i + 1], points[3 * i + 2]];
  const areas = [], units = [], around = Array.from({ length: points.length / 3 }, () => []);
  for (let f = 0; f < count; f++) {
    const [a, b, c] = [0, 1, 2].map((k) => corner(faces[3 * f + k]));
    const normal = cross(minus(b, a), minus(c, a));
    areas.push(normal); units.push(unit(normal));
    for (let k = 0; k < 3; k++) around[faces[3 * f + k]].push(f);
  }
  const content = [], made = around.map(() => []), indices = new Uint32Array(3 * count);
  for (let f = 0; f < count; f++) for (let k = 0; k < 3; k++) {
    const vertex = faces[3 * f + k], sum = [0, 0, 0];
    for (const other of around[vertex]) if (inner(units[f], units[other]) > CREASE)
      for (let i = 0; i < 3; i++) sum[i] += areas[other][i];
    const normal = unit(sum);
    let known = made[vertex].find((each) => inner(each.normal, normal) > ALIKE);
    if (!known) {
      known = { normal, index: content.length / 6 };
      made[vertex].push(known); content.push(...corner(vertex), ...normal);
    }
    indices[3 * f + k] = known.index;
  }
  return { content: new Float32Array(content), indices };
}

// Lines between tiles from -n to n both ways, in pieces that fade one by one.
function grid(n) {
  const ends = [];
  for (let at = -n; at <= n; at++) for (let from = -n; from < n; from++)
    ends.push(at, from, 0, at, from + 1, 0, from, at, 0, from + 1, at, 0);
  return new Float32Array(ends);
}

// Whether a processor draws what a graphics card should: then smooth edges cost too much.
function isSoft() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const told = gl?.getExtension("WEBGL_debug_renderer_info"), name = told && gl.getParameter(told.UNMASKED_RENDERER_WEBGL);
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name || "");
}

class Viewer {
  constructor(canvas, scene, array) {
    this.canvas = canvas;
    const soft = isSoft(), gl = this.gl = canvas.getContext("webgl2", { antialias: !soft, alpha: false });
    if (!gl) throw new Error("no WebGL 2");
    this.surface = this.program(SURFACE_VERTEX, SURFACE_FRAGMENT);
    this.floor = this.program(FLOOR_VERTEX, FLOOR_FRAGMENT);
    this.lines = this.vertices(grid(TILES), ["place"]);
    this.bodies = scene.bodies.map((body) => ({ ...body, shapes: body.surfaces.map((each) => this.shape(each, array)) }));
    this.reach = scene.reach; this.tile = scene.tile;
    this.fine = soft ? 1.5 : Math.min(devicePixelRatio, 2); this.quick = soft ? 0.75 : this.fine;
    this.fade = false; this.asked = false; this.shown = [];
    this.home = { azimuth: -0.65, elevation: 0.38, distance: 0.92 * scene.reach / Math.sin(FIELD_OF_VIEW / 2), target: [...scene.middle] };
    this.device = { distance: 1.4 * scene.device.reach / Math.sin(FIELD_OF_VIEW / 2), target: scene.device.middle };
    this.camera = structuredClone(this.home);
    this.ground = scene.ground;
    this.listen();
    new ResizeObserver(() => this.ask()).observe(canvas);
  }

  program(vertex, fragment) {
    const gl = this.gl, made = gl.createProgram();
    [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]].forEach(([kind, text]) => {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text); gl.compileShader(shader); gl.attachShader(made, shader);
    });
    ["place", "normal"].forEach((name, i) => gl.bindAttribLocation(made, i, name));
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made) || "no shader");
    const count = gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS), at = {};
    for (let i = 0; i < count; i++) { const { name } = gl.getActiveUniform(made, i); at[name] = gl.getUniformLocation(made, name); }
    return { made, at };
  }

  vertices(content, names) {
    const gl = this.gl, array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, content, gl.STATIC_DRAW);
    names.forEach((_, i) => { gl.enableVertexAttribArray(i); gl.vertexAttribPointer(i, 3, gl.FLOAT, false, 12 * names.length, 12 * i); });
    return array;
  }

  shape(surface, array) {
    const gl = this.gl, { content, indices } = shaded(surface, array), made = this.vertices(content, ["place", "normal"]);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    return { array: made, count: indices.length, color: surface.color };
  }

  // What to draw: for each robot the frames of its bodies, and whether it carries the device. Ground null: no floor.
  show(robots, ground, target) {
    this.shown = robots; this.ground = ground;
    if (target) this.camera.target = target;
    this.ask();
  }

  // What moves is drawn quickly, what has come to rest finely.
  ask() {
    clearTimeout(this.resting);
    this.resting = setTimeout(() => this.draw(this.fine), REST);
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame((now) => { this.asked = false; this.adapt(now); this.draw(this.quick); });
  }

  // Fewer pixels keep it fluent where pictures follow each other too slowly.
  adapt(now) {
    const took = now - (this.before ?? now);
    this.before = now;
    if (took === 0 || took > REST) return;
    this.took = 0.8 * (this.took ?? took) + 0.2 * took;
    if (this.took > SLOW && this.quick > COARSEST) { this.quick = Math.max(COARSEST, 0.8 * this.quick); this.took = SLOW / 2; }
  }

  draw(scale) {
    const gl = this.gl, canvas = this.canvas;
    const width = Math.max(1, Math.round(canvas.clientWidth * scale)), height = Math.max(1, Math.round(canvas.clientHeight * scale));
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    const eye = this.eye(), view = seenFrom(eye, this.camera.target, width / height, 0.02 * this.reach, 60 * this.reach);
    gl.viewport(0, 0, width, height);
    // Opaque, for what shines through is drawn twice; in software that takes longer than the robot.
    gl.clearColor(...this.color("backgroundColor"), 1); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST); gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.drawSurfaces(view, eye);
    if (this.ground !== null) this.drawFloor(view);
    canvas.dataset.drawn = Number(canvas.dataset.drawn || 0) + 1;
  }

  drawSurfaces(view, eye) {
    const gl = this.gl, { made, at } = this.surface, back = unit(minus(eye, this.camera.target));
    const left = unit(cross(back, [0, 0, 1]));
    gl.useProgram(made);
    gl.uniformMatrix4fv(at.view, false, view); gl.uniform3fv(at.eye, eye);
    gl.uniform3fv(at.light, unit([0, 1, 2].map((i) => back[i] + 0.5 * left[i] + (i === 2 ? 0.9 : 0))));
    const parts = this.shown.flatMap(({ frames, device }) => this.bodies.flatMap((body, i) =>
      (device || !body.device) ? body.shapes.map((shape) => ({ shape, frame: frames[i], alpha: this.alpha(body, shape) })) : []));
    const draw = ({ shape, frame, alpha }) => {
      gl.uniformMatrix4fv(at.world, false, frame);
      gl.uniform4f(at.color, ...shape.color.slice(0, 3), alpha);
      gl.bindVertexArray(shape.array); gl.drawElements(gl.TRIANGLES, shape.count, gl.UNSIGNED_INT, 0);
    };
    gl.disable(gl.BLEND); gl.depthMask(true);
    parts.filter((part) => part.alpha >= 1).forEach(draw);
    gl.enable(gl.BLEND); gl.depthMask(false);
    parts.filter((part) => part.alpha < 1).forEach(draw);
    gl.depthMask(true);
  }

  // Of the style sheet, which has them for light and for dark.
  color(name) { return getComputedStyle(this.canvas)[name].match(/[\d.]+/g).slice(0, 3).map((part) => part / 255); }

  alpha(body, shape) { return this.fade && !body.device ? Math.min(0.18, shape.color[3]) : shape.color[3]; }

  drawFloor(view) {
    const gl = this.gl, { made, at } = this.floor, { target } = this.camera;
    gl.useProgram(made);
    gl.uniformMatrix4fv(at.view, false, view);
    gl.uniform3f(at.middle, target[0], target[1], this.ground); gl.uniform3fv(at.ink, this.color("color"));
    gl.uniform1f(at.reach, TILES * this.tile); gl.uniform1f(at.tile, this.tile);
    gl.enable(gl.BLEND); gl.depthMask(false);
    gl.bindVertexArray(this.lines); gl.drawArrays(gl.LINES, 0, 8 * TILES * (2 * TILES + 1));
    gl.depthMask(true);
  }

  eye() {
    const { azimuth, elevation, distance, target } = this.camera, flat = distance * Math.cos(elevation);
    return [target[0] + flat * Math.cos(azimuth), target[1] + flat * Math.sin(azimuth), target[2] + distance * Math.sin(elevation)];
  }

  turn(right, up) {
    this.camera.azimuth -= right;
    this.camera.elevation = Math.min(1.5, Math.max(-1.5, this.camera.elevation + up));
    this.ask();
  }

  zoom(factor) {
    this.camera.distance = Math.min(20 * this.reach, Math.max(0.1 * this.reach, this.camera.distance * factor));
    this.ask();
  }

  // From a direction; at all of the robot unless told otherwise.
  look(azimuth, elevation, { distance, target } = this.home) {
    Object.assign(this.camera, { azimuth, elevation, distance, target: [...target] });
    this.ask();
  }

  move(dx, dy) {
    const { camera } = this, back = unit(minus(this.eye(), camera.target)), right = unit(cross([0, 0, 1], back)), up = cross(back, right);
    const length = 2 * Math.tan(FIELD_OF_VIEW / 2) * camera.distance / this.canvas.clientHeight;
    camera.target = camera.target.map((value, i) => value + length * (up[i] * dy - right[i] * dx));
    this.ask();
  }

  listen() {
    const canvas = this.canvas, held = new Map();
    const gap = () => { const [a, b] = [...held.values()]; return Math.hypot(a.x - b.x, a.y - b.y); };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId); held.set(event.pointerId, { x: event.clientX, y: event.clientY });
    });
    canvas.addEventListener("pointermove", (event) => {
      const last = held.get(event.pointerId);
      if (!last) return;
      const before = held.size === 2 ? gap() : 0, dx = event.clientX - last.x, dy = event.clientY - last.y;
      last.x = event.clientX; last.y = event.clientY;
      if (held.size === 2) { this.zoom(before / Math.max(gap(), 1)); this.move(dx / 2, dy / 2); }
      else if (event.shiftKey || event.buttons === 2) this.move(dx, dy);
      else this.turn(0.008 * dx, 0.008 * dy);
    });
    ["pointerup", "pointercancel"].forEach((name) => canvas.addEventListener(name, (event) => held.delete(event.pointerId)));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      // The page scrolls on unless the viewer was chosen first.
      if (document.activeElement !== canvas && !event.ctrlKey) return;
      event.preventDefault(); this.zoom(Math.exp(0.0012 * event.deltaY));
    }, { passive: false });
    const keys = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
    canvas.addEventListener("keydown", (event) => {
      if (keys[event.key]) this.turn(...keys[event.key]);
      else if (event.key === "+" || event.key === "=") this.zoom(0.9);
      else if (event.key === "-") this.zoom(1.1);
      else if (event.key === "Home") this.look(this.home.azimuth, this.home.elevation);
      else return;
      event.preventDefault();
    });
  }
}
