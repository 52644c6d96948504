// A pad for mouse, finger and keys: reports its deflection while held, and rest when released.
const KEYS = { w: [1, 0, 0], s: [-1, 0, 0], a: [0, 1, 0], d: [0, -1, 0], q: [0, 0, 1], e: [0, 0, -1],
               arrowup: [1, 0, 0], arrowdown: [-1, 0, 0], arrowleft: [0, 0, 1], arrowright: [0, 0, -1] };
const PERIOD_MS = 100;

export default {
  template: `<div class="fwk-stick" tabindex="0" role="application" :aria-label="label" @keydown="down" @keyup="up"
    @blur="rest" @pointerdown="press" @pointermove="push" @pointerup="rest" @pointercancel="rest">
    <div class="fwk-knob" :style="{ left: 50 - 50 * at[1] + '%', top: 50 - 50 * at[0] + '%' }"></div></div>`,
  props: { label: String },
  data: () => ({ at: [0, 0, 0], buttons: [] }),
  mounted() {
    this.held = new Set();
    this.timer = setInterval(() => { if (this.active()) this.tell(); }, PERIOD_MS);
    this.hide = () => document.hidden && this.rest();
    document.addEventListener("visibilitychange", this.hide);
  },
  beforeUnmount() {
    clearInterval(this.timer);
    document.removeEventListener("visibilitychange", this.hide);
  },
  methods: {
    active() { return this.pressed || this.held.size > 0; },
    tell() { this.$emit("stick", { at: this.at, buttons: this.buttons, held: this.active() }); },
    fromKeys() {
      const sum = [...this.held].reduce((s, key) => s.map((v, i) => v + (KEYS[key] || [0, 0, 0])[i]), [0, 0, 0]);
      this.at = sum.map((v) => Math.max(-1, Math.min(1, v)));
      this.buttons = [...this.held].filter((key) => /^[0-9]$/.test(key)).map(Number);
      this.tell();
    },
    down(event) {
      const key = event.key.toLowerCase();
      if (event.ctrlKey || event.metaKey || event.altKey || !(key in KEYS || /^[0-9]$/.test(key))) return;
      event.preventDefault();
      if (!event.repeat) { this.held.add(key); this.fromKeys(); }
    },
    up(event) { if (this.held.delete(event.key.toLowerCase())) this.fromKeys(); },
    press(event) {
      this.pressed = true;
      this.$el.setPointerCapture(event.pointerId);
      this.push(event);
    },
    push(event) {
      if (!this.pressed) return;
      const box = this.$el.getBoundingClientRect();
      const part = (value, from, size) => Math.max(-1, Math.min(1, 1 - (2 * (value - from)) / size));
      this.at = [part(event.clientY, box.top, box.height), part(event.clientX, box.left, box.width), 0];
      this.tell();
    },
    rest() {
      if (!this.active()) return;
      this.pressed = false;
      this.held.clear();
      this.at = [0, 0, 0]; this.buttons = [];
      this.tell();
    },
  },
};
