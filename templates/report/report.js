// The controls of the report: which flight, when, how fast; and the cursor in its charts.

const find = (name) => document.getElementById(name);
const TELLING = 100;                  // [ms] between changes of what is written; each costs as much as a picture
const UNSEEN = 2000;                  // [ms] after which the page counts as painted
const WIDER = 1.3;                    // where two robots are shown beside each other
const READOUT = new Intl.NumberFormat("en", { maximumFractionDigits: 0 });

// Angle of a wheel in a frame; a flight has all wheels of a frame one behind the other.
const wheelsOf = (flight) => flight.wheels.length / flight.frames;
const turn = (flight, frame, wheel) => flight.wheels[wheelsOf(flight) * frame + wheel];

class Replay {
  constructor(viewer, scene, array) {
    this.viewer = viewer; this.scene = scene; this.time = 0; this.playing = false; this.index = -1;
    this.flights = scene.flights.map((flight) => ({ ...flight, ...Object.fromEntries(
      ["time", "position", "attitude", "wheels", "tilt"].map((name) => [name, array(flight[name])])) }));
    this.charts = [...document.querySelectorAll("[data-flight] svg.chart")].map((svg) => this.cursor(svg));
    this.listen();
    this.choose();
  }

  listen() {
    find("scene-choice").addEventListener("change", () => { this.time = 0; this.choose(); });
    find("scene-device").addEventListener("change", () => this.choose());
    find("scene-follow").addEventListener("change", () => this.refresh());
    find("scene-play").addEventListener("click", () => this.play(!this.playing));
    find("scene-time").addEventListener("input", (event) => { this.play(false); this.time = Number(event.target.value); this.refresh(); });
    this.viewer.canvas.addEventListener("keydown", (event) => {
      if (event.key !== " " || !this.chosen.length) return;
      event.preventDefault(); this.play(!this.playing);
    });
    document.querySelectorAll("[data-replay]").forEach((button) => button.addEventListener("click", () => {
      find("scene-choice").value = button.dataset.replay; this.time = 0;
      this.choose(); find("robot").scrollIntoView(); this.play(true); find("scene-play").focus();
    }));
  }

  // The flights that are shown: one, or both beside each other.
  choose() {
    const scenario = find("scene-choice").value, carrying = find("scene-device").value;
    const before = this.chosen?.length ?? 1;
    this.chosen = scenario === "" ? [] : this.flights.filter((flight) => flight.scenario === this.scene.scenarios[scenario] &&
      (carrying === "both" || flight.ocs === (carrying === "with")));
    this.index = scenario === "" ? -1 : Number(scenario);
    const still = !this.chosen.length, last = Math.max(0, ...this.chosen.map((flight) => flight.time[flight.frames - 1]));
    ["scene-play", "scene-time", "scene-speed", "scene-device"].forEach((name) => { find(name).disabled = still && (name !== "scene-device" || this.index < 0); });
    find("scene-time").max = last;
    if ((this.chosen.length > 1) !== (before > 1)) this.viewer.zoom(this.chosen.length > 1 ? WIDER : 1 / WIDER);
    this.last = last; this.time = Math.min(this.time, last);
    if (still) { this.play(false); this.viewer.camera.target = [...this.viewer.home.target]; }
    this.refresh();
  }

  play(on) {
    this.playing = on && this.chosen.length > 0;
    const button = find("scene-play");
    button.textContent = this.playing ? "Pause" : "Play";
    button.setAttribute("aria-pressed", this.playing);
    if (!this.playing) return;
    if (this.time >= this.last) this.time = 0;
    this.before = this.told = performance.now();
    requestAnimationFrame((now) => this.step(now));
  }

  step(now) {
    if (!this.playing) return;
    this.time += Math.max(0, now - this.before) / 1000 * Number(find("scene-speed").value);
    this.before = now;
    if (this.time >= this.last) { this.time = this.last; this.play(false); }
    if (!this.playing || now - this.told > TELLING) { this.told = now; this.tell(); }
    this.pose();
    if (this.playing) requestAnimationFrame((later) => this.step(later));
  }

  refresh() { this.tell(); this.pose(); }

  tell() {
    const slider = find("scene-time");
    slider.value = this.time;
    slider.setAttribute("aria-valuetext", `${this.time.toFixed(2)} s`);
    this.charts.forEach((move) => move(this.index, this.time));
    find("scene-readout").textContent = this.chosen.map((flight) => this.words(flight)).join("\n");
  }

  pose() {
    if (!this.chosen.length) { showDesign(this.viewer, this.scene); return; }
    const apart = this.chosen.length > 1 ? this.scene.apart : 0;
    const robots = this.chosen.map((flight, i) => ({ device: flight.ocs, ...this.posed(flight, apart * (0.5 - i)) }));
    const middle = [0, 1, 2].map((k) => robots.reduce((sum, robot) => sum + robot.middle[k], 0) / robots.length);
    this.viewer.show(robots, this.chosen.every((flight) => flight.floor) ? 0 : null, find("scene-follow").checked ? middle : null);
  }

  // Between two recorded frames; the turns of the wheels are counted, so that they never jump.
  at(flight) {
    const step = flight.frames > 1 ? flight.time[1] - flight.time[0] : 1;
    const place = Math.min(Math.max(this.time / step, 0), flight.frames - 1), first = Math.min(Math.floor(place), Math.max(0, flight.frames - 2));
    return { first, next: Math.min(first + 1, flight.frames - 1), part: place - first, step };
  }

  posed(flight, aside) {
    const { first, next, part } = this.at(flight), n = this.scene.bodies.length, between = (a, b) => a + part * (b - a);
    const frames = this.scene.bodies.map((body, i) => {
      const p = [0, 1, 2].map((k) => between(flight.position[3 * (first * n + i) + k], flight.position[3 * (next * n + i) + k]));
      const a = flight.attitude.subarray(4 * (first * n + i), 4 * (first * n + i) + 4), b = flight.attitude.subarray(4 * (next * n + i), 4 * (next * n + i) + 4);
      const sign = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] < 0 ? -1 : 1;
      let q = unit([0, 1, 2, 3].map((k) => between(a[k], sign * b[k])));
      if (body.wheel !== null) q = spun(q, between(turn(flight, first, body.wheel), turn(flight, next, body.wheel)));
      p[1] += aside;
      return placed(q, p);
    });
    const trunk = this.scene.trunk, frame = frames[trunk];
    return { frames, middle: [frame[12], frame[13], frame[14]] };
  }

  words(flight) {
    const { first, next, part, step } = this.at(flight), between = (array, k) => array[2 * first + k] + part * (array[2 * next + k] - array[2 * first + k]);
    const speed = (_, k) => READOUT.format((turn(flight, next, k) - turn(flight, first, k)) / step * 30 / Math.PI);
    const tenths = (value) => (Math.round(10 * value) / 10 || 0).toFixed(1);
    const tilt = `pitch ${tenths(between(flight.tilt, 0))}°, roll ${tenths(between(flight.tilt, 1))}°`;
    const wheels = flight.ocs ? `, wheels ${Array.from({ length: wheelsOf(flight) }, speed).join(" and ")} rpm` : "";
    return `${this.time.toFixed(2)} s, ${flight.ocs ? "with" : "without"}: ${tilt}${wheels}`;
  }

  cursor(svg) {
    const line = document.createElementNS("http://www.w3.org/2000/svg", "path");
    const [low, high, left, right] = svg.dataset.x.split(" ").map(Number), [top, bottom] = svg.dataset.y.split(" ");
    const own = Number(svg.closest("[data-flight]").dataset.flight);
    line.setAttribute("class", "cursor");
    svg.append(line);
    let drawn = "";
    return (index, time) => {
      const x = left + (time - low) / (high - low) * (right - left);
      const path = index === own && x <= right + 0.5 ? `M${x.toFixed(1)} ${top}V${bottom}` : "";
      if (path !== drawn) line.setAttribute("d", drawn = path);
    };
  }
}

// As designed: in its nominal posture.
function showDesign(viewer, scene) {
  const frames = scene.bodies.map((body) => placed(body.attitude, body.position));
  viewer.show([{ device: true, frames }], scene.ground, null);
}

// What can be done without any flight.
function listenToLooks(viewer) {
  document.querySelectorAll("[data-look]").forEach((button) => button.addEventListener("click", () => {
    const { home, device } = viewer, angles = button.dataset.look.split(" ").map(Number);
    const [azimuth, elevation] = angles.length === 2 ? angles : [home.azimuth, home.elevation];
    viewer.look(azimuth, elevation, button.dataset.look === "device" ? device : home);
  }));
  find("scene-fade").addEventListener("change", (event) => { viewer.fade = event.target.checked; viewer.ask(); });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => viewer.ask());
}

async function start() {
  const canvas = find("viewer");
  if (!canvas) return;
  const scene = JSON.parse(find("scene").textContent);
  const array = await unpacked(find("scene-numbers").textContent.trim());
  const viewer = new Viewer(canvas, scene, array);
  listenToLooks(viewer);
  if (scene.flights.length) new Replay(viewer, scene, array); else showDesign(viewer, scene);
  canvas.dataset.state = "ready";
  document.documentElement.classList.add("orbits");
}

// First the page, then its viewer: both at once would keep the page waiting. A tab in the background is
// not painted, and browsers need not tell.
const painted = new Promise((done) => {
  new PerformanceObserver(done).observe({ type: "paint", buffered: true });
  setTimeout(done, UNSEEN);
});
// Where WebGL 2 is missing the picture stays.
painted.then(start).catch((error) => {
  const note = find("viewer-note");
  if (note) note.textContent = `No 3-D view here (${error.message}): the picture shows the same.`;
});
