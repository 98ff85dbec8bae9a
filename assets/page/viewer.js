// SPDX-License-Identifier: Apache-2.0
// The live part of a clip's page (pipelines/page/clip_page.h): the video beside the bodies in their world, and a timeline.
// `./dev page` bundles it with three and uPlot into viewer.bundle.js, which the program carries.
//
// The page holds, by id of its <script> elements:
//   clip   JSON: seconds (one a frame, from the clip's start), people [{name, joints, status, residual_px, sigma_mm,
//          angles {names, tenths_deg: one a frame of each}}],
//          world_from_camera (3x4, rows), K (3x3), image_size, fps, and of a camera that moves cameras: such rows a frame,
//          and of further cameras, which stand still, views [{world_from_camera, K, image_size}]
//   glb    the scene as base64 of a .glb
//   video  base64 of an .mp4 with one image per frame at a constant fps, or empty; video-1, video-2 ...: of the views
// and elements with the ids used below. A page with `live` in its clip (pipelines/live/live_page.h) has no frames: it fetches body.glb
// and takes poses from the events of its server. A fragment "#frame=30&view=side&texture=off" opens it there; "#measure" shows the frame rate.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import uPlot from 'uplot';

const STATUS = ['tracked', 'weak', 'interpolated', 'lost'];
const STATUS_COLOURS = [null, '#e8c54788', '#e8883888', '#d6404088'];
// Of bodies whose texture is taken off, linear: those that data_tools/export/glb_writer.cc gives bodies without one.
const BODY_COLOURS = [[0.62, 0.42, 0.33], [0.26, 0.42, 0.62], [0.30, 0.52, 0.36], [0.55, 0.45, 0.60]];
const SIGMA_LIMIT_MM = 150; // where the scale of the joints' colours ends

const element = (id) => document.getElementById(id);
const bytesOf = (id) => {
  const text = atob(element(id).textContent.trim());
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
};
const clip = JSON.parse(element('clip').textContent);
const wishes = new URLSearchParams(location.hash.slice(1));
const frames = clip.seconds.length;
// Cameras by the end of their elements' ids: "" the first, "-1", "-2" ... the further ones.
const cameras = [clip, ...(clip.views || [])].map((camera, v) => ({ ...camera, end: v === 0 ? '' : `-${v}` }));

/// The last frame that has begun at `second`.
function frameAt(second) {
  let low = 0, high = frames - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (clip.seconds[middle] <= second + 1e-4) low = middle; else high = middle - 1;
  }
  return low;
}

/// Green for what is sure, through yellow to red at the limit; grey where nothing is known.
function sigmaColour(millimetres) {
  if (millimetres === null) return new THREE.Color(0x888888);
  return new THREE.Color().setHSL(0.33 * (1 - Math.min(millimetres / SIGMA_LIMIT_MM, 1)), 0.9, 0.5);
}

class Stage {
  constructor(holder) {
    this.holder = holder;
    this.renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    holder.appendChild(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(0xf2f3f5);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x9a9a90, 1.6));
    const sun = new THREE.DirectionalLight(0xffffff, 1.8);
    sun.position.set(2, 5, 3);
    this.scene.add(sun);
    this.scene.add(new THREE.GridHelper(40, 40, 0xb0b4ba, 0xd9dce0));
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.05, 200);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => this.draw());
    new ResizeObserver(() => this.resize()).observe(holder);
    this.shown = []; // what load() and those it calls put into the scene
  }

  async load(glb) {
    const loader = new GLTFLoader();
    // Textures by image elements: a browser that is driven without a screen waits for those, for image bitmaps it does not.
    loader.register((parser) => {
      parser.textureLoader = new THREE.TextureLoader(parser.options.manager);
      return { name: 'image_elements' };
    });
    const gltf = await loader.parseAsync(glb, '');
    for (const old of this.shown) {
      this.scene.remove(old);
      old.traverse((node) => { node.geometry?.dispose(); node.material?.dispose(); });
    }
    this.shown = [gltf.scene];
    this.scene.add(gltf.scene);
    this.bodies = [];
    this.extra = [];
    gltf.scene.traverse((node) => {
      node.frustumCulled = false; // a posed skin leaves the box of its rest pose
      if (node.isSkinnedMesh) {
        node.material = node.material.clone();
        this.bodies.push({ mesh: node, texture: node.material.map });
      }
      if (node.name === 'ground') node.visible = false; // the grid is clearer
    });
    this.mixer = new THREE.AnimationMixer(gltf.scene);
    this.duration = 0;
    for (const animation of clip.live ? [] : gltf.animations) {
      this.mixer.clipAction(animation).play();
      this.duration = Math.max(this.duration, animation.duration);
    }
    if (this.bodies.every(({ texture }) => !texture)) element('show-texture').parentElement.style.display = 'none';
    this.people = clip.people.map((person, index) => this.addJoints(gltf.scene, person, index));
    this.addFrusta();
    this.holdCentre(0);
    this.view(wishes.get('view') || 'front');
    return gltf.scene;
  }

  addJoints(root, person, index) {
    const holder = root.getObjectByName(person.name) || root;
    const bones = [];
    holder.traverse((node) => { if (node.isBone) bones.push(node); });
    const ball = new THREE.SphereGeometry(0.022, 12, 8);
    return bones.map((bone) => {
      const material = new THREE.MeshBasicMaterial({ depthTest: false, transparent: true });
      const sphere = new THREE.Mesh(ball, material);
      sphere.renderOrder = 2;
      sphere.frustumCulled = false;
      this.shown.push(sphere);
      this.scene.add(sphere);
      return { bone, sphere, joint: person.joints.indexOf(bone.userData.name || bone.name), person: index };
    });
  }

  addFrusta() {
    this.cameras = cameras.filter((camera) => camera.K && camera.image_size).map((camera) => {
      const [width, height] = camera.image_size;
      const [[fx, , cx], [, fy, cy]] = camera.K;
      const depth = 0.6;
      const corner = (u, v) => new THREE.Vector3((u - cx) / fx * depth, (v - cy) / fy * depth, depth);
      const eye = new THREE.Vector3();
      const corners = [corner(0, 0), corner(width, 0), corner(width, height), corner(0, height)];
      const lines = [];
      for (let i = 0; i < 4; ++i) lines.push(eye, corners[i], corners[i], corners[(i + 1) % 4]);
      const frustum = new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(lines),
                                             new THREE.LineBasicMaterial({ color: 0x3366cc }));
      frustum.matrixAutoUpdate = false;
      this.shown.push(frustum);
      this.scene.add(frustum);
      return { ...camera, frustum, fieldOfView: 2 * Math.atan(height / (2 * fy)) * 180 / Math.PI };
    });
    this.moveCameras(0);
  }

  // To where the frame was seen from.
  moveCameras(frame) {
    for (const camera of this.cameras) {
      const m = camera.cameras ? camera.cameras[frame] : camera.world_from_camera;
      camera.frustum.matrix.set(...m[0], ...m[1], ...m[2], 0, 0, 0, 1);
      camera.frustum.matrixWorldNeedsUpdate = true;
      camera.eye = new THREE.Vector3(m[0][3], m[1][3], m[2][3]);
      camera.ahead = new THREE.Vector3(m[0][2], m[1][2], m[2][2]);
    }
  }

  centreAt(second) {
    this.pose(second);
    const centre = new THREE.Vector3(), place = new THREE.Vector3();
    let count = 0;
    for (const joints of this.people) {
      if (joints.length === 0 || !this.isShown(joints[0].bone)) continue;
      joints[0].bone.getWorldPosition(place);
      centre.add(place);
      count += 1;
    }
    return count > 0 ? centre.divideScalar(count) : new THREE.Vector3(0, 1, -3);
  }

  holdCentre(second) { this.centre = this.centreAt(second); }

  isShown(bone) { return bone.getWorldScale(new THREE.Vector3()).x > 0.01; }

  view(name) {
    const spread = 1.2 * this.people.length;
    const distance = 3.2 + spread;
    const at = this.centre.clone();
    const places = {
      front: [0, 0.3, distance], side: [distance, 0.3, 0], back: [0, 0.3, -distance], top: [0, distance + 1, 0.01],
    };
    this.camera.fov = 40;
    const from = this.cameras.find(({ end }) => name === `camera${end}`);
    if (from) {
      this.camera.fov = from.fieldOfView;
      this.camera.position.copy(from.eye);
      at.copy(from.eye).addScaledVector(from.ahead, this.centre.distanceTo(from.eye));
    } else {
      this.camera.position.copy(at).add(new THREE.Vector3(...(places[name] || places.front)));
    }
    this.controls.target.copy(at);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  pose(second) {
    if (!clip.live) this.mixer.setTime(Math.min(Math.max(second, 0), Math.max(this.duration - 1e-4, 0)));
    this.scene.updateMatrixWorld(true);
  }

  show(frame) {
    this.moveCameras(frame);
    this.pose(clip.seconds[frame]);
    const showJoints = element('show-joints').checked;
    this.bodies.forEach(({ mesh, texture }, index) => {
      mesh.visible = element('show-body').checked;
      mesh.material.transparent = showJoints;
      mesh.material.opacity = showJoints ? 0.75 : 1;
      if (texture) this.wear(mesh.material, element('show-texture').checked ? texture : null, index);
    });
    for (const joints of this.people) {
      for (const { bone, sphere, joint, person } of joints) {
        sphere.visible = showJoints && joint >= 0 && this.isShown(bone);
        if (!sphere.visible) continue;
        bone.getWorldPosition(sphere.position);
        const row = clip.people[person].sigma_mm[frame];
        sphere.material.color.copy(sigmaColour(row ? row[joint] : null));
      }
    }
    for (const { frustum } of this.cameras) frustum.visible = element('show-camera').checked;
    this.draw();
  }

  wear(material, texture, index) {
    if (material.map === texture) return;
    material.map = texture;
    material.color.setRGB(...(texture ? [1, 1, 1] : BODY_COLOURS[index % BODY_COLOURS.length]));
    material.needsUpdate = true;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.holder;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() { this.renderer.render(this.scene, this.camera); }
}

class Timeline {
  constructor(holder, jump) {
    this.frame = 0;
    const colours = ['#2b6cb0', '#b7472a', '#2f855a', '#805ad5', '#975a16'];
    const series = [{ label: 'second', value: (u, v) => (v === null ? '' : v.toFixed(2)) }];
    const data = [clip.seconds];
    clip.people.forEach((person, index) => {
      series.push({ label: `${person.name}: residual, px`, stroke: colours[index % colours.length], scale: 'px', width: 1.5 });
      data.push(person.residual_px);
      const mean = person.sigma_mm.map((row) => {
        const known = row ? row.filter((v) => v !== null) : [];
        return known.length ? known.reduce((a, b) => a + b, 0) / known.length : null;
      });
      series.push({ label: 'σ of joints, mm', stroke: colours[index % colours.length], scale: 'mm', dash: [4, 3], width: 1 });
      data.push(mean);
    });
    this.plot = new uPlot({
      width: holder.clientWidth || 800, height: 240, series, cursor: { drag: { x: false, y: false } },
      scales: { x: { time: false }, px: { range: (u, low, high) => [0, Math.max(high || 1, 1)] }, mm: { range: (u, low, high) => [0, Math.max(high || 1, 1)] } },
      axes: [{ label: 'seconds' }, { scale: 'px', label: 'px' }, { scale: 'mm', side: 1, label: 'mm', grid: { show: false } }],
      hooks: { drawClear: [(plot) => this.drawStatuses(plot)], draw: [(plot) => this.drawPlace(plot)] },
    }, data, holder);
    this.plot.over.addEventListener('click', (event) => {
      const left = event.clientX - this.plot.over.getBoundingClientRect().left;
      jump(frameAt(this.plot.posToVal(left, 'x')));
    });
    new ResizeObserver(() => this.plot.setSize({ width: holder.clientWidth, height: 240 })).observe(holder);
  }

  drawStatuses(plot) {
    const { ctx, bbox } = plot;
    const band = bbox.height / clip.people.length;
    ctx.save();
    clip.people.forEach((person, index) => {
      person.status.forEach((status, frame) => {
        const colour = STATUS_COLOURS[status];
        if (!colour) return;
        const left = plot.valToPos(clip.seconds[frame], 'x', true);
        const end = frame + 1 < frames ? clip.seconds[frame + 1] : clip.seconds[frame] + 1 / clip.fps;
        ctx.fillStyle = colour;
        ctx.fillRect(left, bbox.top + index * band, Math.max(plot.valToPos(end, 'x', true) - left, 1), band);
      });
    });
    ctx.restore();
  }

  drawPlace(plot) {
    const { ctx, bbox } = plot;
    const x = plot.valToPos(clip.seconds[this.frame], 'x', true);
    ctx.save();
    ctx.strokeStyle = '#111';
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.restore();
  }

  show(frame) {
    this.frame = frame;
    this.plot.redraw(false);
  }
}

// A small plot for each joint angle, both sides in one. The curves are drawn once; a line in front follows the frame.
class AnglePlots {
  constructor(holder, jump) {
    this.holder = holder;
    this.frame = 0;
    this.plots = holder.querySelector('.plots');
    this.people = clip.people.filter((person) => person.angles);
    if (this.people.length === 0) { holder.style.display = 'none'; return; }
    const choice = element('angles-of');
    choice.replaceChildren(...this.people.map((person, index) => new Option(person.name, index)));
    choice.style.display = this.people.length > 1 ? '' : 'none';
    choice.addEventListener('change', () => this.choose(this.people[choice.value]));
    choice.addEventListener('click', (event) => event.preventDefault()); // does not fold the summary around it
    this.plots.addEventListener('click', (event) => {
      const figure = event.target.closest('figure');
      if (!figure) return;
      const box = figure.getBoundingClientRect();
      const start = clip.seconds[0], end = clip.seconds[frames - 1];
      jump(frameAt(start + (event.clientX - box.left) / box.width * (end - start)));
    });
    this.choose(this.people[0]);
    new ResizeObserver(() => this.draw()).observe(this.plots);
  }

  choose(person) {
    this.person = person;
    const { names, tenths_deg: tenths } = person.angles;
    const curve = (name) => tenths[names.indexOf(name)].map((v) => (v === null ? null : v / 10));
    this.figures = [...new Set(names.map((name) => name.replace(/_[rl]$/, '')))].map((name) => {
      const curves = names.includes(name) ? [['#4a5568', curve(name)]] : [['#b7472a', curve(`${name}_r`)], ['#2b6cb0', curve(`${name}_l`)]];
      const figure = document.createElement('figure');
      figure.innerHTML = '<figcaption></figcaption><canvas></canvas><i></i>';
      const [caption, canvas, line] = figure.children;
      return { name: name.replaceAll('_', ' '), curves, figure, caption, canvas, line };
    });
    this.plots.replaceChildren(...this.figures.map(({ figure }) => figure));
    this.draw();
  }

  draw() {
    const scale = window.devicePixelRatio || 1;
    const start = clip.seconds[0], length = (clip.seconds[frames - 1] - start) || 1;
    for (const shown of this.figures || []) {
      const { curves, canvas } = shown;
      const width = canvas.clientWidth, height = canvas.clientHeight;
      if (width === 0) continue;
      shown.width = width; // asked for here alone: the answer costs a layout
      canvas.width = width * scale;
      canvas.height = height * scale;
      const values = curves.flatMap(([, degrees]) => degrees.filter((v) => v !== null));
      const middle = values.length ? (Math.max(...values) + Math.min(...values)) / 2 : 0;
      const half = Math.max(15, ...values.map((v) => Math.abs(v - middle))) * 1.08; // a joint at rest is a flat line
      const y = (v) => height * (0.5 - 0.5 * (v - middle) / half);
      const context = canvas.getContext('2d');
      context.scale(scale, scale);
      context.fillStyle = '#fff';
      context.fillRect(0, 0, width, height);
      const step = [10, 20, 45, 90, 180, 360, 720].find((s) => half / s < 2.2) || 1440;
      context.font = '10px system-ui, sans-serif';
      for (let v = Math.ceil((middle - half) / step) * step; v <= middle + half; v += step) {
        context.fillStyle = v === 0 ? '#a0aec0' : '#e2e8f0';
        context.fillRect(0, Math.round(y(v)), width, 1);
        context.fillStyle = '#718096';
        if (y(v) > 10) context.fillText(`${v}`, 2, y(v) - 2);
      }
      for (const [colour, degrees] of curves) {
        context.strokeStyle = colour;
        context.beginPath();
        let pen = false;
        degrees.forEach((v, frame) => {
          if (v === null) { pen = false; return; }
          const x = (clip.seconds[frame] - start) / length * width;
          if (pen) context.lineTo(x, y(v)); else context.moveTo(x, y(v));
          pen = true;
        });
        context.stroke();
      }
    }
    this.show(this.frame);
  }

  show(frame) {
    this.frame = frame;
    if (!this.figures || !this.holder.open) return;
    const start = clip.seconds[0], length = (clip.seconds[frames - 1] - start) || 1;
    for (const { name, curves, width, caption, line } of this.figures) {
      line.style.transform = `translateX(${(clip.seconds[frame] - start) / length * ((width || 1) - 1)}px)`;
      caption.textContent = `${name} ${curves.map(([, degrees]) => (degrees[frame] === null ? '–' : `${Math.round(degrees[frame])}°`)).join(', ')}`;
    }
  }
}

async function main() {
  const stage = new Stage(element('stage'));
  await stage.load(bytesOf('glb').buffer);
  stage.resize();
  const videos = cameras.filter(({ end }) => element(`video${end}`).textContent.trim() !== '')
    .map(({ end }) => ({ player: element(`picture${end}`), bytes: `video${end}` }));
  const hasVideo = videos.length > 0;
  let current = -1, playing = false, startedAt = 0, startedFrom = 0;

  function show(frame, moveVideo) {
    frame = Math.min(Math.max(frame, 0), frames - 1);
    if (frame === current) return;
    current = frame;
    stage.show(frame);
    timeline.show(frame);
    anglePlots.show(frame);
    element('slider').value = frame;
    const words = clip.people.map((person) => {
      const px = person.residual_px[frame];
      return `${person.name}: ${STATUS[person.status[frame]]}${px === null ? '' : `, ${px.toFixed(1)} px`}`;
    });
    element('place').textContent = `frame ${frame} of ${frames}, ${clip.seconds[frame].toFixed(2)} s; ${words.join('; ')}`;
    // The middle of the frame's time: a player shows the frame before when asked for its first instant.
    if (moveVideo) for (const { player } of videos) player.currentTime = (frame + 0.5) / clip.fps;
  }
  const timeline = new Timeline(element('timeline'), (frame) => show(frame, true));
  const anglePlots = new AnglePlots(element('angles'), (frame) => show(frame, true));

  for (const { player, bytes } of videos) {
    player.src = URL.createObjectURL(new Blob([bytesOf(bytes)], { type: 'video/mp4' }));
  }
  if (hasVideo) {
    videos[0].player.addEventListener('ended', () => play(false));
  } else {
    element('seen').style.display = 'none';
    element('stage').style.gridColumn = '1 / -1';
  }
  function play(on) {
    playing = on;
    element('play').textContent = on ? 'Pause' : 'Play';
    if (on && current === frames - 1) show(0, true);
    startedAt = performance.now();
    startedFrom = clip.seconds[current];
    for (const { player } of videos) on ? player.play() : player.pause();
    if (on) requestAnimationFrame(step);
  }
  // Players of further views drift by their own clocks; one that is a frame away from the first is put back.
  function keepInStep() {
    for (const { player } of videos.slice(1)) {
      if (Math.abs(player.currentTime - videos[0].player.currentTime) > 1.5 / clip.fps) player.currentTime = videos[0].player.currentTime;
    }
  }
  function step() {
    if (!playing) return;
    if (hasVideo) keepInStep();
    show(hasVideo ? Math.floor(videos[0].player.currentTime * clip.fps) : frameAt(startedFrom + (performance.now() - startedAt) / 1000), false);
    if (!hasVideo && current === frames - 1) return play(false);
    requestAnimationFrame(step);
  }
  element('play').addEventListener('click', () => play(!playing));
  element('slider').max = frames - 1;
  element('slider').addEventListener('input', (event) => { play(false); show(Number(event.target.value), true); });
  document.addEventListener('keydown', (event) => {
    if (event.target.tagName === 'INPUT' && event.target.type !== 'checkbox') return;
    if (event.key === ' ') { event.preventDefault(); play(!playing); }
    if (event.key === 'ArrowRight') { play(false); show(current + 1, true); }
    if (event.key === 'ArrowLeft') { play(false); show(current - 1, true); }
  });
  for (const name of ['front', 'side', 'back', 'top', ...cameras.map(({ end }) => `camera${end}`)]) {
    element(`view-${name}`).addEventListener('click', () => {
      stage.holdCentre(clip.seconds[current]);
      stage.show(current);
      stage.view(name);
    });
  }
  for (const id of ['show-body', 'show-texture', 'show-joints', 'show-camera']) {
    element(id).addEventListener('change', () => stage.show(current));
  }
  for (const link of document.querySelectorAll('a[data-blob]')) {
    link.addEventListener('click', () => {
      link.href = URL.createObjectURL(new Blob([bytesOf(link.dataset.blob)], { type: link.type }));
    });
  }
  showSigmaScale();

  if (wishes.get('texture') === 'off') element('show-texture').checked = false;
  const first = Number(wishes.get('frame') || 0);
  show(first, true);
  if (wishes.get('view')) { stage.holdCentre(clip.seconds[current]); stage.show(current); stage.view(wishes.get('view')); }
  if (wishes.has('measure')) {
    const begin = performance.now(), rounds = 60;
    for (let i = 0; i < rounds; ++i) {
      stage.show(i % frames);
      const gl = stage.renderer.getContext();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits until it is drawn
    }
    element('place').textContent = `${(1000 * rounds / (performance.now() - begin)).toFixed(1)} pictures a second`;
  }
  document.body.dataset.ready = 'yes';
}

// The body as it is tracked: each event holds the newest pose (pipelines/live/live_state.h), and the number of the shape, for which the
// body is fetched anew.
class LiveBody {
  constructor(stage) {
    this.stage = stage;
    this.shape = 0;
    this.drawn = []; // when, of the last two seconds
    const events = new EventSource('events');
    events.onmessage = (message) => {
      this.newest = JSON.parse(message.data);
      this.tell(this.newest.state);
    };
    events.onerror = () => { element('place').textContent = 'the connection is lost, looking for it'; };
    const next = async () => {
      const data = this.newest;
      this.newest = null;
      try {
        if (data) await this.take(data);
      } catch (error) {
        console.error(error);
        element('place').textContent = `This browser cannot show the body: ${error.message}`;
      }
      requestAnimationFrame(next);
    };
    requestAnimationFrame(next);
  }

  // Also where nothing is drawn, as in a page that lies behind another.
  tell({ status, seconds, delay_ms: delay, dropped, world }) {
    const now = performance.now();
    this.drawn = this.drawn.filter((then) => now - then < 2000);
    element('place').textContent = `${status}, ${seconds.toFixed(1)} s; ${delay.toFixed(0)} ms after it was seen; ` +
      `drawn ${(this.drawn.length / 2).toFixed(0)} times a second; ${dropped} frames passed over; world by: ${world.source}`;
  }

  async take({ shape, pose_mean: mean, state }) {
    const isFirst = this.shape === 0;
    if (state.poses && shape !== this.shape) await this.fetchBody(shape, state);
    if (!this.bones) return;
    this.show(state, mean);
    if (isFirst) this.centre();
    this.drawn.push(performance.now());
    document.body.dataset.ready = 'yes';
  }

  async fetchBody(shape, state) {
    const answer = await fetch('body.glb');
    if (!answer.ok) return;
    const { camera, world } = state;
    clip.K = [[camera.fx, 0, camera.cx], [0, camera.fy, camera.cy], [0, 0, 1]];
    clip.image_size = [camera.width, camera.height];
    Object.assign(cameras[0], { K: clip.K, image_size: clip.image_size, world_from_camera: rowsOf(world) });
    const stage = this.stage, place = stage.camera.position.clone(), target = stage.controls.target.clone();
    this.root = await stage.load(await answer.arrayBuffer());
    const { skeleton } = stage.bodies[0].mesh;
    this.bones = skeleton.bones;
    clip.people[0].joints = this.bones.map((bone) => bone.userData.name || bone.name);
    for (const joint of stage.people[0]) joint.joint = this.bones.indexOf(joint.bone);
    if (this.shape !== 0) { // as it was seen before
      stage.camera.position.copy(place);
      stage.controls.target.copy(target);
      stage.controls.update();
    }
    this.shape = shape;
  }

  show({ poses, joints, joint_sigma: sigma, world }, mean) {
    const rows = rowsOf(world);
    const worldFromCamera = new THREE.Matrix4().set(...rows[0], ...rows[1], ...rows[2], 0, 0, 0, 1);
    // Whoever is lost is a point, as in a clip's scene.
    this.bones[0].parent.scale.setScalar(poses ? 1 : 1e-3);
    if (poses) {
      const turn = new THREE.Vector3();
      this.bones.forEach((bone, j) => {
        turn.set(...[0, 1, 2].map((k) => poses[3 * j + k] + (mean ? mean[3 * j + k] : 0)));
        const angle = turn.length();
        bone.quaternion.setFromAxisAngle(angle > 0 ? turn.divideScalar(angle) : turn.set(1, 0, 0), angle);
      });
      this.bones[0].quaternion.premultiply(new THREE.Quaternion().setFromRotationMatrix(worldFromCamera));
      this.bones[0].position.set(...joints[0]).applyMatrix4(worldFromCamera);
    }
    for (const camera of this.stage.cameras) camera.world_from_camera = rows;
    clip.people[0].sigma_mm[0] = sigma && sigma.map((metres) => (metres === null ? null : 1000 * metres));
    this.stage.show(0);
    if (poses) this.follow();
  }

  // The view goes along with whoever walks away from its middle.
  follow() {
    const { stage } = this;
    const away = this.bones[0].getWorldPosition(new THREE.Vector3()).sub(stage.centre);
    if (away.length() < 0.5) return;
    away.multiplyScalar(0.1);
    stage.centre.add(away);
    stage.camera.position.add(away);
    stage.controls.target.add(away);
    stage.controls.update();
  }

  centre(name) {
    this.stage.holdCentre(0);
    this.stage.show(0);
    this.stage.view(name || wishes.get('view') || 'front');
  }
}

const rowsOf = ({ rotation, translation }) => rotation.map((row, i) => [...row, translation[i]]);

function showSigmaScale() {
  element('scale').style.background =
    `linear-gradient(to right, ${[0, 0.25, 0.5, 0.75, 1].map((x) => `#${sigmaColour(x * SIGMA_LIMIT_MM).getHexString()}`).join(', ')})`;
  element('scale-end').textContent = `${SIGMA_LIMIT_MM} mm`;
}

async function live() {
  const stage = new Stage(element('stage'));
  stage.resize();
  const body = new LiveBody(stage);
  for (const name of ['front', 'side', 'back', 'top', 'camera']) {
    element(`view-${name}`).addEventListener('click', () => { if (body.bones) body.centre(name); });
  }
  for (const id of ['show-body', 'show-joints', 'show-camera']) {
    element(id).addEventListener('change', () => { if (body.bones) stage.show(0); });
  }
  if (wishes.has('joints')) element('show-joints').checked = true;
  showSigmaScale();
}

(clip.live ? live : main)().catch((error) => {
  console.error(error);
  element('place').textContent = `This browser cannot show the scene: ${error.message}`;
});
