// Shows the drawings of a view. Asks for a drawing only after the last drawing has come; a hidden page asks for nothing.
// Shapes glide from drawing to drawing, so that motion is smooth however rarely drawings come. A glide takes the time
// between two drawings and ends at the last one exactly; no shape is ever ahead of the drawings. Where the run lacks
// processor time, pictures are as rare as their cost demands.
const TRAIL_MS = 2000;
const LEAST_PX = 3.7;
const RETRY_MS = 1000;
const PICTURE_MS = 45; // from picture to picture of a glide: more than 20 pictures a second
const EARLY_MS = 4; // a picture may come so much earlier, rather than a whole refresh of the screen later
const SHARE = 0.025; // of a processor for pictures where the run lacks processor time; other threads of the browser need more
const COSTS = 9; // pictures whose cost is known
const DEAREST_MS = 500; // from picture to picture
const LONGEST_MS = 1500; // glide
const SAME_M = 0.003; // difference between lengths that are equal before positions are rounded

const angle = (from, to, turn) => to - from - turn * Math.round((to - from) / turn); // the short way
const mean = (a, b, part) => a + part * (b - a);

/** Returns by how much a line or polygon turns that keeps its lengths; 0 for others, whose points move straight. */
function turned(from, to) {
  const arms = [from, to].map(({ p }) => p.map(([x, y]) => [x - p[0][0], y - p[0][1]]));
  const rigid = arms[0].every((arm, i) => Math.abs(Math.hypot(...arm) - Math.hypot(...arms[1][i])) < SAME_M);
  return rigid ? angle(...arms.map(([, [x, y]]) => Math.atan2(y, x)), 2 * Math.PI) : 0;
}

/** Returns for each shape of a drawing the same shape of the drawing before, if there is one, and its turn. */
export function paired(before, after) {
  const grouped = (shapes) => Map.groupBy(shapes, (s) => [s.k, s.l, s.of, s.pick, s.trail].join("\n"));
  const [old, made] = [grouped(before), grouped(after)];
  return [...made].flatMap(([key, shapes]) => shapes.map((to, i) => {
    const same = old.get(key);
    const from = same?.length === shapes.length && same[i].p?.length === to.p?.length ? same[i] : null;
    return { from, to, turn: from && to.p?.length > 1 ? turned(from, to) : 0 };
  }));
}

/** Returns a shape on its way. */
export function between({ from, to, turn }, part) {
  if (!from || part >= 1) return to;
  const made = { ...to };
  for (const name of ["x", "y", "r", "a", "b"]) if (name in to) made[name] = mean(from[name], to[name], part);
  if ("t" in to) made.t = from.t + part * angle(from.t, to.t, Math.PI);
  if (turn) {
    const start = [0, 1].map((i) => mean(from.p[0][i], to.p[0][i], part));
    const [cos, sin] = [Math.cos(part * turn), Math.sin(part * turn)];
    made.p = from.p.map(([px, py]) => [px - from.p[0][0], py - from.p[0][1]])
      .map(([x, y]) => [start[0] + cos * x - sin * y, start[1] + sin * x + cos * y]);
  } else if (to.p) made.p = to.p.map((point, i) => point.map((value, j) => mean(from.p[i][j], value, part)));
  return made;
}

/** Returns the time from picture to picture: longer where the run lacks processor time and pictures are dear. */
export function pictureTime(costs, scarce) {
  const middle = [...costs].sort((a, b) => a - b)[costs.length >> 1] || 0;
  return scarce ? Math.min(DEAREST_MS, Math.max(PICTURE_MS, middle / SHARE)) : PICTURE_MS;
}

export default {
  template: `<div class="fwk-canvas"><canvas tabindex="0" role="img" :aria-label="label"></canvas></div>`,
  props: { url: String, label: String, period: { type: Number, default: 50 }, hidden: { type: Array, default: () => [] },
           drags: Boolean, images: String },
  mounted() {
    this.canvas = this.$el.firstChild;
    this.scale = 0; // pixels a metre; 0: not chosen yet
    this.trails = new Map();
    this.drawing = null;
    this.image = null;
    this.up = 1; // y points up; over an image down
    this.layers = "";
    this.open = true;
    this.frames = 0;
    this.have = ""; // name of the drawing that is shown
    this.ground = { name: "", shapes: [] };
    this.shapes = []; // as they are shown
    this.pairs = []; // of the glide
    this.periods = []; // of the last drawings
    [this.came, this.pictureDue, this.pictures] = [0, 0, 0];
    this.costs = []; // time that the last pictures took, in ms
    this.scarce = false; // the run lacks processor time
    this.painted = new MessageChannel();
    this.painted.port1.onmessage = ({ data }) => (this.costs = [...this.costs, performance.now() - data].slice(-COSTS));
    [this.due, this.pace] = [0, this.period];
    const on = (name, handle, options) => this.canvas.addEventListener(name, handle, options);
    on("wheel", (e) => { e.preventDefault(); this.zoom(e.deltaY < 0 ? 1.15 : 1 / 1.15, e.offsetX, e.offsetY); },
       { passive: false });
    on("pointerdown", this.press); on("pointermove", this.move); on("pointerup", this.release);
    on("keydown", this.key); on("dblclick", () => { this.scale = 0; this.paint(); });
    this.pointers = new Map();
    new ResizeObserver(() => { if (this.fitted) this.scale = 0; this.paint(); }).observe(this.canvas);
    this.ask();
  },
  beforeUnmount() {
    this.open = false;
    clearTimeout(this.next); cancelAnimationFrame(this.frame); this.painted.port1.close();
  },
  watch: { hidden() { this.paint(); } },
  methods: {
    async ask() {
      if (!this.open) return;
      if (document.hidden) return document.addEventListener("visibilitychange", this.ask, { once: true });
      this.due += this.pace;
      if (this.due < performance.now() - this.pace) this.due = performance.now();
      try {
        const answer = await fetch(`${this.url}&have=${this.have}&ground=${this.ground.name}`);
        this.pace = Math.max(this.period, Number(answer.headers.get("fwk-period-ms")));
        this.scarce = this.pace > this.period;
        if (answer.ok) await this.take(answer);
        else this.pace = RETRY_MS; // the run has ended, or is not there yet
      } catch (error) { this.pace = RETRY_MS; }
      setTimeout(this.ask, this.due + this.pace - performance.now());
    },
    async load(picture) {
      const url = `${this.images}&channel=${encodeURIComponent(picture.camera)}&frame=${picture.frame}`;
      if (url === this.loaded) return;
      const answer = await fetch(url);
      if (!answer.ok) return;
      this.image = await createImageBitmap(await answer.blob());
      this.loaded = url;
      this.canvas.dataset.picture = picture.frame;
    },
    async take(answer) {
      if (answer.status === 200) {
        const drawing = await answer.json();
        if (drawing.picture) await this.load(drawing.picture);
        this.have = drawing.picture && !this.image ? "" : answer.headers.get("fwk-drawing");
        if (drawing.ground) this.ground = drawing.ground;
        this.show(drawing, answer.headers.get("fwk-glides") === "1");
      }
      this.frames += 1;
      this.canvas.dataset.frames = this.frames;
    },
    show(drawing, glides) {
      const now = performance.now();
      const period = now - this.came;
      if (period < LONGEST_MS) this.periods = [...this.periods, period].slice(-3);
      this.came = now;
      const known = glides && this.drawing && !drawing.picture ? this.shapes : [];
      this.pairs = paired(known, drawing.shapes);
      this.began = now;
      this.glide = Math.max(this.period, ...this.periods);
      for (const shape of this.shapes) if (shape.trail) {
        const trail = this.trails.get(shape.trail) || [];
        trail.push([now, shape.x, shape.y]);
        while (trail.length && trail[0][0] < now - TRAIL_MS) trail.shift();
        this.trails.set(shape.trail, trail);
      }
      this.drawing = drawing;
      this.up = drawing.picture ? -1 : 1;
      const layers = [...new Set([...this.ground.shapes, ...drawing.shapes].map((s) => s.l).filter(Boolean))].sort();
      if (layers.join("\n") !== this.layers) {
        this.layers = layers.join("\n");
        this.$emit("layers", layers);
      }
      if (drawing.headline !== this.headline) this.$emit("headline", (this.headline = drawing.headline));
      if (this.pairs.some((each) => each.from)) this.wait(); // the glide begins with what is shown already
      else this.advance();
    },
    /** Shows the next picture when it is due. */
    wait() {
      clearTimeout(this.next);
      cancelAnimationFrame(this.frame);
      const wait = this.pictureDue - EARLY_MS - performance.now();
      this.next = setTimeout(() => (this.frame = requestAnimationFrame(this.advance)), wait);
    },
    /** Shows where the shapes are now, again and again until the glide has ended. */
    advance() {
      clearTimeout(this.next);
      cancelAnimationFrame(this.frame);
      const began = performance.now();
      const part = this.pairs.some((each) => each.from) ? Math.min(1, (began - this.began) / this.glide) : 1;
      const time = pictureTime(this.costs, this.scarce);
      this.pictureDue = Math.max(this.pictureDue + time, began + time / 2);
      this.shapes = this.pairs.map((pair) => between(pair, part));
      this.paint();
      this.canvas.dataset.pictures = ++this.pictures;
      this.painted.port2.postMessage(began); // comes when the browser has painted
      if (part < 1) this.wait();
    },
    /** Returns what a fitted drawing shows: its bounds, otherwise all places that shapes have had. */
    box() {
      if (this.drawing.bounds) return this.drawing.bounds;
      const points = [...this.ground.shapes, ...this.drawing.shapes].flatMap((s) => s.p || [[s.x, s.y]]);
      const [xs, ys] = [points.map((p) => p[0]), points.map((p) => p[1])];
      const [left, low, right, high] = this.places || [0, 0, 0, 0];
      const beyond = !this.places || Math.min(...xs) < left || Math.min(...ys) < low
                     || Math.max(...xs) > right || Math.max(...ys) > high;
      if (points.length && beyond) {
        const old = this.places || [Infinity, Infinity, -Infinity, -Infinity];
        this.places = [Math.min(old[0], ...xs.map((x) => x - 1)), Math.min(old[1], ...ys.map((y) => y - 1)),
                       Math.max(old[2], ...xs.map((x) => x + 1)), Math.max(old[3], ...ys.map((y) => y + 1))];
      }
      return this.places || [-5, -5, 5, 5];
    },
    fit(width, height) {
      const box = this.box();
      this.fittedTo = box.join();
      this.scale = Math.min(width / (box[2] - box[0]), height / (box[3] - box[1]));
      this.middle = [(box[0] + box[2]) / 2, (box[1] + box[3]) / 2];
      this.fitted = true; // until it is zoomed or shifted
    },
    paint() {
      if (!this.drawing) return;
      const dots = window.devicePixelRatio || 1;
      const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
      if (!width || !height) return;
      if (this.canvas.width !== width * dots || this.canvas.height !== height * dots) {
        this.canvas.width = width * dots; this.canvas.height = height * dots;
      }
      if (!this.scale || (this.fitted && !this.pressed && this.box().join() !== this.fittedTo)) this.fit(width, height);
      this.canvas.dataset.scale = String(Math.round(this.scale * 100) / 100);
      const pen = this.canvas.getContext("2d");
      pen.setTransform(1, 0, 0, 1, 0, 0);
      pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
      const s = this.scale * dots;
      const place = [s, 0, 0, -s * this.up, (width * dots) / 2 - this.middle[0] * s,
                     (height * dots) / 2 + this.middle[1] * s * this.up];
      this.paintGround(pen, place);
      pen.setTransform(...place);
      if (this.drawing.picture && this.image)
        pen.drawImage(this.image, -0.5, -0.5, this.drawing.picture.width, this.drawing.picture.height);
      pen.lineCap = "round"; pen.lineJoin = "round";
      const shown = this.shapes.filter((shape) => !this.hidden.includes(shape.l));
      for (const shape of shown) if (shape.trail) this.paintTrail(pen, shape);
      for (const shape of shown) this.paintShape(pen, shape);
    },
    paintGround(pen, place) {
      const { width, height } = this.canvas;
      const background = this.drawing.background || "transparent";
      const key = [this.ground.name, background, width, height, ...place, ...this.hidden].join();
      if (key !== this.groundKey) {
        this.groundKey = key;
        this.groundLayer = new OffscreenCanvas(width, height);
        const below = this.groundLayer.getContext("2d");
        below.fillStyle = background;
        below.fillRect(0, 0, width, height);
        below.setTransform(...place);
        below.lineCap = "round"; below.lineJoin = "round";
        for (const shape of this.ground.shapes) if (!this.hidden.includes(shape.l)) this.paintShape(below, shape);
      }
      pen.drawImage(this.groundLayer, 0, 0);
    },
    paintTrail(pen, shape) {
      const trail = this.trails.get(shape.trail) || [];
      pen.strokeStyle = shape.fill || shape.stroke; pen.lineWidth = shape.r / 3; pen.globalAlpha = 0.35;
      pen.beginPath();
      for (const [, x, y] of trail) pen.lineTo(x, y);
      pen.lineTo(shape.x, shape.y);
      pen.stroke(); pen.globalAlpha = 1;
    },
    paintShape(pen, shape) {
      pen.lineWidth = Math.max(shape.width || 0, 1 / this.scale);
      pen.setLineDash(shape.dashed ? [0.1, 0.1] : []);
      pen.beginPath();
      if (shape.k === "text") return this.paintText(pen, shape);
      const place = this.dragged && shape.drag === this.dragged.name ? this.dragged : shape;
      if (shape.k === "circle") pen.arc(place.x, place.y, shape.r, 0, 2 * Math.PI);
      else if (shape.k === "ellipse") pen.ellipse(shape.x, shape.y, shape.a, shape.b, shape.t, 0, 2 * Math.PI);
      else for (const [x, y] of shape.p) pen.lineTo(x, y);
      if (shape.k === "polygon") pen.closePath();
      if (shape.fill) { pen.fillStyle = shape.fill; pen.fill(); }
      if (shape.stroke) { pen.strokeStyle = shape.stroke; pen.stroke(); }
      if (shape.pick && shape.pick === this.picked) {
        pen.lineWidth = 2.5 / this.scale; pen.strokeStyle = "#ffeb3b"; pen.setLineDash([]);
        pen.beginPath(); pen.arc(place.x, place.y, shape.r + 4 / this.scale, 0, 2 * Math.PI); pen.stroke();
      }
    },
    paintText(pen, shape) {
      if (shape.h * this.scale < LEAST_PX) return; // a text this small is unreadable; zooming shows it
      pen.save();
      pen.translate(shape.x, shape.y); pen.scale(0.01, -0.01 * this.up);
      pen.font = `${Math.max(shape.h * 100, 900 / this.scale)}px system-ui, sans-serif`;
      pen.textAlign = "center"; pen.textBaseline = "middle"; pen.fillStyle = shape.fill;
      pen.fillText(shape.s, 0, 0);
      pen.restore();
    },
    at(event) {
      const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
      return [this.middle[0] + (event.offsetX - width / 2) / this.scale,
              this.middle[1] - (this.up * (event.offsetY - height / 2)) / this.scale];
    },
    hit(x, y, what) {
      let best = null, least = Infinity;
      for (const shape of this.shapes) {
        if (shape.k !== "circle" || !shape[what] || this.hidden.includes(shape.l)) continue;
        const away = Math.hypot(shape.x - x, shape.y - y);
        if (away < Math.max(shape.r, 10 / this.scale) && away < least) { best = shape; least = away; }
      }
      return best;
    },
    zoom(factor, x, y) {
      if (!this.scale) return;
      const before = this.at({ offsetX: x, offsetY: y });
      this.scale = Math.min(5000, Math.max(0.5, this.scale * factor));
      const after = this.at({ offsetX: x, offsetY: y });
      this.middle = [this.middle[0] + before[0] - after[0], this.middle[1] + before[1] - after[1]];
      this.fitted = false;
      this.paint();
    },
    press(event) {
      if (!this.scale) return;
      this.canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
      const [x, y] = this.at(event);
      const shape = this.drags && this.hit(x, y, "drag");
      this.pressed = { x: event.offsetX, y: event.offsetY, moved: false };
      if (shape) this.dragged = { name: shape.drag, x, y };
    },
    move(event) {
      if (!this.pressed || !this.pointers.has(event.pointerId)) return;
      const last = this.pointers.get(event.pointerId);
      this.pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
      if (Math.hypot(event.offsetX - this.pressed.x, event.offsetY - this.pressed.y) > 4) this.pressed.moved = true;
      if (this.pointers.size === 2) {
        const other = [...this.pointers.entries()].find(([id]) => id !== event.pointerId)[1];
        const away = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]);
        this.zoom(away([event.offsetX, event.offsetY]) / Math.max(1, away(last)), other[0], other[1]);
      } else if (this.dragged) {
        [this.dragged.x, this.dragged.y] = this.at(event);
        this.paint();
      } else {
        this.fitted = this.fitted && !this.pressed.moved;
        this.middle = [this.middle[0] - (event.offsetX - last[0]) / this.scale,
                       this.middle[1] + (this.up * (event.offsetY - last[1])) / this.scale];
        this.paint();
      }
    },
    release(event) {
      if (!this.pressed) return;
      this.pointers.delete(event.pointerId);
      if (this.dragged && this.pressed.moved) this.$emit("moved", this.dragged);
      if (!this.pressed.moved) {
        const shape = this.hit(...this.at(event), "pick");
        this.picked = shape ? shape.pick : "";
        this.$emit("pick", this.picked);
      }
      this.dragged = null;
      if (!this.pointers.size) this.pressed = null;
      this.paint();
    },
    key(event) {
      const [x, y] = [this.canvas.clientWidth / 2, this.canvas.clientHeight / 2];
      const step = 40 / (this.scale || 1);
      const up = step * this.up;
      const moves = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, up], ArrowDown: [0, -up] };
      if (event.key === "+") this.zoom(1.2, x, y);
      else if (event.key === "-") this.zoom(1 / 1.2, x, y);
      else if (event.key === "0") { this.scale = 0; this.paint(); }
      else if (event.key === "Tab" || !(event.key in moves)) return;
      else { this.middle = this.middle.map((m, i) => m + moves[event.key][i]); this.fitted = false; this.paint(); }
      event.preventDefault();
    },
  },
};
