// SPDX-License-Identifier: Apache-2.0
// The live part of an avatar's page (pipelines/gaussian_avatar/avatar_page.h): a Gaussian avatar, posed, lit, sorted and drawn here.
// Needs no library and is embedded in the program unchanged.
//
// The page holds, by id of its <script> elements:
//   avatar     JSON: gaussians n, joints, influences, key_interval, unit (metres), image_size, K [fx, fy, cx, cy], up,
//              light (3x9, a row a colour), seconds (one a frame)
//   gaussians  base64 of float32, a column of n after the other: place 3, quaternion 4 (w first), standard deviations 3,
//              opacity, albedo 3, normal 3, weights and joints (`influences` each)
//   bones      float32, frames x joints x 3x4; NaN where nobody is shown
//   changes    int8, key frames x 3 x n, in units: what is added to place as it is seen; keys are every key_interval-th frame and the
//              last
// Formulas: render/gaussian_avatar/pose_gaussians.h and render/splat/project_gaussians.h. A fragment "#frame=30&yaw=90" opens it there,
// "&plain" shows the image alone, at its own size on black, and "&measure" shows the frame rate.
(() => {
  'use strict';
  const LOW_PASS = 0.2;            // px^2
  const LEAST_ALPHA = 1 / 255, MOST_ALPHA = 0.99;
  const NEAREST_M = 0.1;
  const SH = [0.28209479, 0.48860251, 1.09254843, 0.31539157, 0.54627422];

  const element = (id) => document.getElementById(id);
  const bytesOf = (id) => {
    const text = atob(element(id).textContent.trim());
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    return bytes.buffer;
  };
  const person = JSON.parse(element('avatar').textContent);
  const wishes = new URLSearchParams(location.hash.slice(1));
  const n = person.gaussians, frames = person.seconds.length, influences = person.influences;
  const table = new Float32Array(bytesOf('gaussians'));
  const columns = (first, count) => Array.from({ length: count }, (_, c) => table.subarray((first + c) * n, (first + c + 1) * n));
  const PLACE = columns(0, 3), TURN = columns(3, 4), SCALE = columns(7, 3), OPACITY = columns(10, 1)[0], ALBEDO = columns(11, 3),
    NORMAL = columns(14, 3), WEIGHT = columns(17, influences), JOINT = columns(17 + influences, influences);
  const bones = new Float32Array(bytesOf('bones')), changes = new Int8Array(bytesOf('changes'));
  const isShown = (frame) => !Number.isNaN(bones[frame * person.joints * 12]);
  const keys = [];
  for (let t = 0; t < frames; ++t) if (t % person.key_interval === 0 || t === frames - 1) keys.push(t);

  /// View-independent data of a frame: positions, covariance factors and colours in the frame of the source camera.
  const posed = { frame: -1, middle: [0, 0, 0], place: new Float32Array(3 * n), factor: new Float32Array(9 * n), colour: new Float32Array(3 * n) };

  function pose(frame) {
    if (posed.frame === frame) return;
    posed.frame = frame;
    let key = 0;
    while (key + 1 < keys.length && keys[key + 1] <= frame) ++key;
    const next = Math.min(key + 1, keys.length - 1);
    let part = next > key ? (frame - keys[key]) / (keys[next] - keys[key]) : 0;
    if (!isShown(keys[key])) part = 1; else if (!isShown(keys[next])) part = 0; // a key without a person says nothing
    const before = 3 * key * n, after = 3 * next * n, first = frame * person.joints * 12;
    const change = (channel, i) => person.unit * ((1 - part) * changes[before + channel * n + i] + part * changes[after + channel * n + i]);
    const m = new Float64Array(12), r = new Float64Array(9), light = person.light;
    posed.middle.fill(0);
    for (let i = 0; i < n; ++i) {
      m.fill(0);
      for (let k = 0; k < influences; ++k) {
        const w = WEIGHT[k][i], at = first + 12 * JOINT[k][i];
        if (w > 0) for (let e = 0; e < 12; ++e) m[e] += w * bones[at + e];
      }
      const x = PLACE[0][i], y = PLACE[1][i], z = PLACE[2][i];
      for (let c = 0; c < 3; ++c) {
        posed.place[3 * i + c] = m[4 * c] * x + m[4 * c + 1] * y + m[4 * c + 2] * z + m[4 * c + 3] + change(c, i);
        posed.middle[c] += posed.place[3 * i + c] / n;
      }
      const w = TURN[0][i], a = TURN[1][i], b = TURN[2][i], d = TURN[3][i];
      r[0] = 1 - 2 * (b * b + d * d); r[1] = 2 * (a * b - w * d); r[2] = 2 * (a * d + w * b);
      r[3] = 2 * (a * b + w * d); r[4] = 1 - 2 * (a * a + d * d); r[5] = 2 * (b * d - w * a);
      r[6] = 2 * (a * d - w * b); r[7] = 2 * (b * d + w * a); r[8] = 1 - 2 * (a * a + b * b);
      for (let c = 0; c < 3; ++c) {
        const scale = SCALE[c][i];
        for (let row = 0; row < 3; ++row) {
          posed.factor[9 * i + 3 * row + c] = scale * (m[4 * row] * r[c] + m[4 * row + 1] * r[3 + c] + m[4 * row + 2] * r[6 + c]);
        }
      }
      let nx = m[0] * NORMAL[0][i] + m[1] * NORMAL[1][i] + m[2] * NORMAL[2][i];
      let ny = m[4] * NORMAL[0][i] + m[5] * NORMAL[1][i] + m[6] * NORMAL[2][i];
      let nz = m[8] * NORMAL[0][i] + m[9] * NORMAL[1][i] + m[10] * NORMAL[2][i];
      const length = Math.hypot(nx, ny, nz), inverse = length > 1e-6 ? 1 / length : 0;
      nx *= inverse; ny *= inverse; nz *= inverse;
      for (let c = 0; c < 3; ++c) {
        const L = 9 * c;
        const shading = light[L] * SH[0] + SH[1] * (light[L + 1] * ny + light[L + 2] * nz + light[L + 3] * nx) +
          SH[2] * (light[L + 4] * nx * ny + light[L + 5] * ny * nz + light[L + 7] * nx * nz) +
          SH[3] * light[L + 6] * (3 * nz * nz - 1) + SH[4] * light[L + 8] * (nx * nx - ny * ny);
        posed.colour[3 * i + c] = ALBEDO[c][i] * shading;
      }
    }
  }

  // ---- The view: turned about the mean of the person's Gaussians, about the vertical and up and down; nearer or farther along the ray to it.
  const up = (() => { const l = Math.hypot(...person.up); return person.up.map((v) => v / l); })();
  const view = { yaw: Number(wishes.get('yaw') || 0), pitch: 0, distance: 1 };

  function turnAbout(axis, degrees) {
    const c = Math.cos(degrees * Math.PI / 180), s = Math.sin(degrees * Math.PI / 180), [x, y, z] = axis;
    return [c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s,
      y * x * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s,
      z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)];
  }
  const times = (A, B) => A.map((_, i) => {
    const row = 3 * Math.floor(i / 3), column = i % 3;
    return A[row] * B[column] + A[row + 1] * B[3 + column] + A[row + 2] * B[6 + column];
  });
  const at = (A, v) => [0, 3, 6].map((row) => A[row] * v[0] + A[row + 1] * v[1] + A[row + 2] * v[2]);

  // ---- Drawing: a square a Gaussian, from the farthest to the nearest, premultiplied.
  const canvas = element('picture'), stage = element('stage');
  const gl = canvas.getContext('webgl2', { alpha: true, premultipliedAlpha: true, antialias: false, preserveDrawingBuffer: true });
  if (!gl) {
    element('place').textContent = 'This browser shows no WebGL 2, which the picture needs.';
    return;
  }
  function shader(type, source) {
    const made = gl.createShader(type);
    gl.shaderSource(made, source);
    gl.compileShader(made);
    if (!gl.getShaderParameter(made, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(made));
    return made;
  }
  function linked(vertex, fragment) {
    const made = gl.createProgram();
    gl.attachShader(made, shader(gl.VERTEX_SHADER, vertex));
    gl.attachShader(made, shader(gl.FRAGMENT_SHADER, fragment));
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
    return made;
  }
  const program = linked(`#version 300 es
    in vec2 corner; in vec2 centre; in vec4 axes; in vec4 colour;
    uniform vec2 size;
    out vec2 at; out vec4 shown;
    void main() {
      // In standard deviations; farther out alpha is too small to show.
      at = corner * sqrt(max(0.0, 2.0 * log(colour.a / ${LEAST_ALPHA})));
      shown = colour;
      vec2 pixel = centre + at.x * axes.xy + at.y * axes.zw;
      gl_Position = vec4(2.0 * (pixel.x + 0.5) / size.x - 1.0, 1.0 - 2.0 * (pixel.y + 0.5) / size.y, 0.0, 1.0);
    }`, `#version 300 es
    precision highp float;
    in vec2 at; in vec4 shown; out vec4 result;
    void main() {
      float alpha = min(${MOST_ALPHA}, shown.a * exp(-0.5 * dot(at, at)));
      if (alpha < ${LEAST_ALPHA}) discard;
      result = vec4(shown.rgb * alpha, alpha);
    }`);
  // Colours of a Gaussian may be negative or above one, and only their sum is a colour: they are added in half floats.
  const sums = gl.getExtension('EXT_color_buffer_float') ? { target: gl.createFramebuffer(), texture: gl.createTexture(), width: 0, height: 0 } : null;
  const copy = sums && linked(`#version 300 es
    void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }`, `#version 300 es
    precision highp float;
    uniform sampler2D picture; out vec4 result;
    void main() { result = clamp(texelFetch(picture, ivec2(gl_FragCoord.xy), 0), 0.0, 1.0); }`);
  function beginSums() {
    if (!sums) return;
    if (sums.width !== canvas.width || sums.height !== canvas.height) {
      [sums.width, sums.height] = [canvas.width, canvas.height];
      gl.bindTexture(gl.TEXTURE_2D, sums.texture);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, sums.width, sums.height, 0, gl.RGBA, gl.HALF_FLOAT, null);
      for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
      gl.bindFramebuffer(gl.FRAMEBUFFER, sums.target);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, sums.texture, 0);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, sums.target);
  }
  function endSums() {
    if (!sums) return;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.useProgram(copy);
    gl.disable(gl.BLEND);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.enable(gl.BLEND);
    gl.useProgram(program);
  }
  gl.useProgram(program);
  const size = gl.getUniformLocation(program, 'size');
  const FLOATS = 10; // of a Gaussian on the screen: centre 2, axes 4, colour 4
  const screen = new Float32Array(FLOATS * n), ordered = new Float32Array(FLOATS * n);
  const buffers = [gl.createBuffer(), gl.createBuffer()];
  function attribute(name, size, stride, offset, divisor) {
    const place = gl.getAttribLocation(program, name);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, gl.FLOAT, false, 4 * stride, 4 * offset);
    gl.vertexAttribDivisor(place, divisor);
  }
  gl.bindBuffer(gl.ARRAY_BUFFER, buffers[0]);
  gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), gl.STATIC_DRAW);
  attribute('corner', 2, 2, 0, 0);
  gl.bindBuffer(gl.ARRAY_BUFFER, buffers[1]);
  gl.bufferData(gl.ARRAY_BUFFER, ordered.byteLength, gl.DYNAMIC_DRAW);
  attribute('centre', 2, FLOATS, 0, 1);
  attribute('axes', 4, FLOATS, 2, 1);
  attribute('colour', 4, FLOATS, 6, 1);
  gl.disable(gl.DEPTH_TEST);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);

  const depth = new Float32Array(n), rank = new Uint16Array(n), starts = new Uint32Array(65537), shown = new Uint32Array(n);

  /// Brings the posed Gaussians to the screen; returns how many are seen.
  function project() {
    const scale = canvas.height / person.image_size[1], [fx, fy, cx, cy] = person.K;
    const middle = posed.middle;
    const right = (() => { // across the ray to the person and the vertical
      const ray = middle, r = [up[1] * ray[2] - up[2] * ray[1], up[2] * ray[0] - up[0] * ray[2], up[0] * ray[1] - up[1] * ray[0]];
      const l = Math.hypot(...r);
      return l > 1e-6 ? r.map((v) => v / l) : [1, 0, 0];
    })();
    const V = times(turnAbout(right, view.pitch), turnAbout(up, view.yaw));
    const turned = at(V, middle), shift = [0, 1, 2].map((c) => view.distance * middle[c] - turned[c]);
    let seen = 0, nearest = Infinity, farthest = 0;
    const B = new Float64Array(6);
    for (let i = 0; i < n; ++i) {
      const px = posed.place[3 * i], py = posed.place[3 * i + 1], pz = posed.place[3 * i + 2];
      const x = V[0] * px + V[1] * py + V[2] * pz + shift[0], y = V[3] * px + V[4] * py + V[5] * pz + shift[1],
        z = V[6] * px + V[7] * py + V[8] * pz + shift[2];
      if (!(z > NEAREST_M) || OPACITY[i] < LEAST_ALPHA) continue;
      const jx = scale * fx / z, jy = scale * fy / z;
      for (let c = 0; c < 3; ++c) {
        const f0 = posed.factor[9 * i + c], f1 = posed.factor[9 * i + 3 + c], f2 = posed.factor[9 * i + 6 + c];
        const v0 = V[0] * f0 + V[1] * f1 + V[2] * f2, v1 = V[3] * f0 + V[4] * f1 + V[5] * f2, v2 = V[6] * f0 + V[7] * f1 + V[8] * f2;
        B[c] = jx * (v0 - x / z * v2);
        B[3 + c] = jy * (v1 - y / z * v2);
      }
      const a = B[0] * B[0] + B[1] * B[1] + B[2] * B[2] + LOW_PASS, b = B[0] * B[3] + B[1] * B[4] + B[2] * B[5],
        c = B[3] * B[3] + B[4] * B[4] + B[5] * B[5] + LOW_PASS;
      // Axes of the ellipse: eigenvectors of [a b; b c] times the roots of its eigenvalues.
      const mean = 0.5 * (a + c), spread = Math.hypot(0.5 * (a - c), b);
      const l1 = Math.sqrt(mean + spread), l2 = Math.sqrt(Math.max(mean - spread, 1e-9));
      const angle = 0.5 * Math.atan2(2 * b, a - c), cosine = Math.cos(angle), sine = Math.sin(angle);
      const to = FLOATS * i;
      screen[to] = jx * x + scale * (cx + 0.5) - 0.5;
      screen[to + 1] = jy * y + scale * (cy + 0.5) - 0.5;
      screen[to + 2] = l1 * cosine; screen[to + 3] = l1 * sine;
      screen[to + 4] = -l2 * sine; screen[to + 5] = l2 * cosine;
      screen[to + 6] = posed.colour[3 * i]; screen[to + 7] = posed.colour[3 * i + 1]; screen[to + 8] = posed.colour[3 * i + 2];
      screen[to + 9] = OPACITY[i];
      depth[i] = z;
      nearest = Math.min(nearest, z);
      farthest = Math.max(farthest, z);
      shown[seen++] = i;
    }
    // Counting sort by 16 bits of depth, farthest first.
    const step = farthest > nearest ? 65535 / (farthest - nearest) : 0;
    starts.fill(0);
    for (let s = 0; s < seen; ++s) {
      rank[s] = (farthest - depth[shown[s]]) * step;
      ++starts[rank[s] + 1];
    }
    for (let r = 0; r < 65536; ++r) starts[r + 1] += starts[r];
    for (let s = 0; s < seen; ++s) {
      const from = FLOATS * shown[s], to = FLOATS * starts[rank[s]]++;
      for (let e = 0; e < FLOATS; ++e) ordered[to + e] = screen[from + e];
    }
    return seen;
  }

  let measured = false;
  let frame = Math.min(Math.max(0, Number(wishes.get('frame') || 0) | 0), frames - 1);
  function draw() {
    beginSums();
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    const there = isShown(frame);
    if (there) {
      pose(frame);
      const seen = project();
      gl.uniform2f(size, canvas.width, canvas.height);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, ordered, 0, FLOATS * seen);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, seen);
    }
    endSums();
    element('slider').value = frame;
    if (measured) return;
    element('place').textContent = `frame ${frame} of ${frames}, ${person.seconds[frame].toFixed(2)} s` + (there ? '' : ': nobody is shown');
  }
  stage.style.maxWidth = `${80 * person.image_size[0] / person.image_size[1]}vh`; // a tall image fits the window
  // If rendering is slow (no GPU), the resolution is reduced during motion.
  let sharpness = 1, lastMoved = 0;
  function moved() {
    const now = performance.now(), taken = now - lastMoved;
    lastMoved = now;
    if (taken > 60 && taken < 1000 && sharpness > 0.3) {
      sharpness *= 0.7;
      resize();
    } else {
      draw();
    }
  }
  function rested() {
    sharpness = 1;
    resize();
  }
  function resize() {
    const [width, height] = person.image_size;
    const ratio = wishes.has('plain') ? 1 : sharpness * stage.clientWidth * Math.min(window.devicePixelRatio, 2) / width;
    canvas.width = Math.round(ratio * width);
    canvas.height = Math.round(ratio * height);
    if (wishes.has('plain')) {
      stage.classList.add('plain');
      stage.style.maxWidth = 'none';
      canvas.style.width = `${width}px`;
      document.body.style.overflow = 'hidden';
    }
    draw();
  }

  // ---- By hand.
  let playing = !wishes.has('frame') && !wishes.has('measure'), begun = 0;
  const duration = person.seconds[frames - 1] + (frames > 1 ? person.seconds[frames - 1] / (frames - 1) : 1);
  function setPlaying(plays) {
    playing = plays;
    element('play').textContent = plays ? 'Pause' : 'Play';
    begun = performance.now() / 1000 - person.seconds[frame];
    if (plays) requestAnimationFrame(tick); else if (sharpness < 1) rested();
  }
  function tick() {
    if (!playing) return;
    const second = (performance.now() / 1000 - begun) % duration;
    let now = frame;
    if (person.seconds[now] > second) now = 0;
    while (now + 1 < frames && person.seconds[now + 1] <= second) ++now;
    if (now !== frame) {
      frame = now;
      moved();
    }
    requestAnimationFrame(tick);
  }
  function go(to) {
    setPlaying(false);
    frame = Math.min(Math.max(0, to), frames - 1);
    draw();
  }
  element('slider').max = frames - 1;
  element('slider').addEventListener('input', (event) => go(Number(event.target.value)));
  element('play').addEventListener('click', () => setPlaying(!playing));
  for (const [id, yaw] of [['view-front', 0], ['view-left', 90], ['view-back', 180], ['view-right', 270]]) {
    element(id).addEventListener('click', () => {
      Object.assign(view, { yaw, pitch: 0, distance: 1 });
      draw();
    });
  }
  let held = null;
  canvas.addEventListener('pointerdown', (event) => {
    held = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener('pointermove', (event) => {
    if (!held) return;
    view.yaw -= 0.4 * (event.clientX - held[0]);
    view.pitch = Math.min(80, Math.max(-80, view.pitch - 0.3 * (event.clientY - held[1])));
    held = [event.clientX, event.clientY];
    if (!playing) moved();
  });
  canvas.addEventListener('pointerup', () => {
    held = null;
    if (!playing) rested();
  });
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    view.distance = Math.min(5, Math.max(0.25, view.distance * Math.exp(0.001 * event.deltaY)));
    draw();
  }, { passive: false });
  document.addEventListener('keydown', (event) => {
    if (event.key === ' ') setPlaying(!playing);
    else if (event.key === 'ArrowLeft') go(frame - 1);
    else if (event.key === 'ArrowRight') go(frame + 1);
    else return;
    event.preventDefault();
  });
  new ResizeObserver(() => requestAnimationFrame(resize)).observe(stage); // afterwards: it changes the stage's height
  resize();
  setPlaying(playing);
  if (wishes.has('measure')) {
    const count = 20, start = performance.now();
    for (let i = 0; i < count; ++i) {
      frame = i % frames;
      view.yaw = 6 * i;
      draw();
      gl.finish();
    }
    element('place').textContent = `${(1000 * count / (performance.now() - start)).toFixed(1)} pictures a second, each of another frame and side`;
    measured = true;
  }
  document.body.dataset.ready = 'yes';
})();
