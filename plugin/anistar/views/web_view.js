// Views of meshes that turn: a picture stands there until it is touched, then WebGL draws it.
"use strict";

const VERTEX = `#version 300 es
uniform mat3 turn;
uniform vec3 middle;
uniform vec2 scale;
in vec3 place;
in vec3 colour;
in vec3 corner;
out vec3 shade, where, inside;
void main() {
  where = turn * (place - middle);
  shade = colour;
  inside = corner;
  gl_Position = vec4(where.xy * scale, -where.z * 0.25 * min(scale.x, scale.y), 1.0);
}`;

// A facet that is seen edge-on keeps 60 % of its colour; its edges are a pixel wide.
const FRAGMENT = `#version 300 es
precision highp float;
in vec3 shade, where, inside;
out vec4 pixel;
void main() {
  vec3 normal = normalize(cross(dFdx(where), dFdy(where)));
  vec3 lit = shade * (0.6 + 0.4 * abs(normal.z));
  vec3 near = inside / fwidth(inside);
  float line = 1.0 - smoothstep(0.3, 1.1, min(near.x, min(near.y, near.z)));
  pixel = vec4(mix(lit, vec3(0.11, 0.15, 0.2), 0.75 * line), 1.0);
}`;

// Browsers keep a dozen or so contexts alive: the oldest view becomes its picture again.
const MOST_VIEWS = 8;
const views = [];

function decoded(text, Kind) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Kind(bytes.buffer);
}

// Three corners for each triangle: flat shades and edges need corners of their own.
function expanded(data) {
  const points = decoded(data.points, Uint16Array);
  const triangles = decoded(data.triangles, Uint32Array);
  const shades = decoded(data.shades, Uint8Array);
  const palette = decoded(data.palette, Uint8Array);
  const place = new Float32Array(triangles.length * 3);
  const colour = new Uint8Array(triangles.length * 3);
  const corner = new Uint8Array(triangles.length * 3);
  triangles.forEach((point, k) => {
    const shade = shades[Math.floor(k / 3)];
    for (let i = 0; i < 3; i++) {
      place[3 * k + i] = data.low[i] + (points[3 * point + i] / 65535) * data.extent[i];
      colour[3 * k + i] = palette[3 * shade + i];
      corner[3 * k + i] = k % 3 === i ? 255 : 0;
    }
  });
  return { place, colour, corner, count: triangles.length };
}

function compiled(gl) {
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw gl.getProgramInfoLog(program);
  return program;
}

function loaded(gl, program, arrays) {
  gl.useProgram(program);
  const kinds = { place: gl.FLOAT, colour: gl.UNSIGNED_BYTE, corner: gl.UNSIGNED_BYTE };
  for (const [name, kind] of Object.entries(kinds)) {
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, arrays[name], gl.STATIC_DRAW);
    const slot = gl.getAttribLocation(program, name);
    gl.enableVertexAttribArray(slot);
    gl.vertexAttribPointer(slot, 3, kind, kind !== gl.FLOAT, 0, 0);
  }
  gl.enable(gl.DEPTH_TEST);
  gl.clearColor(1, 1, 1, 1);
}

// Rows: to the right, upwards and to the eye; given to WebGL by columns.
function turned(azimuth, height) {
  const [c, s, e, f] = [Math.cos(azimuth), Math.sin(azimuth), Math.cos(height), Math.sin(height)];
  return [-s, -c * f, c * e, c, -s * f, s * e, 0, e, f];
}

class View {
  constructor(figure) {
    const data = JSON.parse(figure.querySelector("script").textContent);
    const arrays = expanded(data);
    this.figure = figure;
    this.picture = figure.querySelector("img");
    this.canvas = document.createElement("canvas");
    this.canvas.tabIndex = 0;
    const width = this.picture.clientWidth || 600, height = this.picture.clientHeight || 510;
    this.canvas.width = width * (window.devicePixelRatio || 1);
    this.canvas.height = height * (window.devicePixelRatio || 1);
    this.canvas.style.cssText = `width:${width}px;height:${height}px;touch-action:none`;
    this.gl = this.canvas.getContext("webgl2", { preserveDrawingBuffer: true, antialias: true });
    if (!this.gl) throw "this browser has no WebGL 2";
    this.program = compiled(this.gl);
    loaded(this.gl, this.program, arrays);
    this.count = arrays.count;
    this.middle = data.low.map((low, i) => low + data.extent[i] / 2);
    this.size = Math.hypot(...data.extent);
    this.start = [Math.atan2(data.view[1], data.view[0]), Math.asin(data.view[2])];
    this.reset();
    this.picture.replaceWith(this.canvas);
    this.listen();
    this.draw();
  }
  reset() {
    [this.azimuth, this.height] = this.start;
    this.zoom = 1;
  }
  turn(right, up) {
    this.azimuth -= right;
    this.height = Math.max(-1.57, Math.min(1.57, this.height + up));
    this.draw();
  }
  draw() {
    const { gl, program, canvas } = this;
    const short = Math.min(canvas.width, canvas.height);
    const size = (1.9 * this.zoom) / this.size;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const uniform = (name) => gl.getUniformLocation(program, name);
    gl.uniformMatrix3fv(uniform("turn"), false, turned(this.azimuth, this.height));
    gl.uniform3fv(uniform("middle"), this.middle);
    gl.uniform2f(uniform("scale"), (size * short) / canvas.width, (size * short) / canvas.height);
    gl.drawArrays(gl.TRIANGLES, 0, this.count);
  }
  listen() {
    const { canvas } = this;
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons) this.turn(event.movementX * 0.01, event.movementY * 0.01);
    });
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom *= Math.exp(-event.deltaY * 0.001);
      this.draw();
    }, { passive: false });
    canvas.addEventListener("dblclick", () => { this.reset(); this.draw(); });
    canvas.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
      if (!step[event.key]) return;
      event.preventDefault();
      this.turn(...step[event.key]);
    });
  }
  close() {
    this.canvas.replaceWith(this.picture);
    this.gl.getExtension("WEBGL_lose_context")?.loseContext();
  }
}

function open(figure) {
  try {
    views.push(new View(figure));
  } catch (error) {
    figure.querySelector(".muted").textContent = `It cannot turn here: ${error}`;
    return;
  }
  if (views.length > MOST_VIEWS) views.shift().close();
  views.at(-1).canvas.focus();
}

for (const figure of document.querySelectorAll("figure.turns")) {
  figure.addEventListener("pointerdown", (event) => {
    if (event.target.tagName === "IMG") { event.preventDefault(); open(figure); }
  });
}
