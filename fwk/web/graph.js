// Shows the graph of a system, in a shadow tree, so that the style of the drawing does not reach the page.
/** Lets Tab reach the components. */
function reachable(drawing) {
  for (const node of drawing.querySelectorAll("g")) {
    node.setAttribute("tabindex", "0");
    node.setAttribute("role", "button");
  }
  return drawing;
}

export default {
  template: `<div class="fwk-graph" role="group" :aria-label="label" @click="choose" @keydown="key"></div>`,
  props: { url: String, label: String, period: Number },
  mounted() {
    this.shadow = this.$el.attachShadow({ mode: "open" });
    this.ask();
  },
  beforeUnmount() { clearTimeout(this.next); },
  watch: { url() { this.ask(); } },
  methods: {
    async ask() {
      clearTimeout(this.next);
      const url = this.url;
      const answer = document.hidden ? null : await fetch(url).catch(() => null);
      const text = answer?.ok ? await answer.text() : "";
      if (url !== this.url || !this.$el.isConnected) return; // another question is under way, or the page has gone
      if (text) this.show(reachable(new DOMParser().parseFromString(text, "image/svg+xml").documentElement), url);
      this.next = setTimeout(this.ask, this.period);
    },
    /** Replaces the drawing, or only its words and states, so that the tooltip under the mouse stays. */
    show(made, url) {
      const old = this.shadow.firstChild;
      const [before, after] = [old, made].map((each) => (each ? [...each.querySelectorAll("*")] : []));
      if (url !== this.shown) this.$el.scrollTo(0, 0);
      if (url !== this.shown || before.length !== after.length) this.shadow.replaceChildren(made);
      else after.forEach((each, i) => {
        const [now, state] = [before[i], each.getAttribute("class")];
        if (state !== now.getAttribute("class")) now.setAttribute("class", state);
        if (!each.children.length && each.textContent !== now.textContent) now.textContent = each.textContent;
      });
      this.shown = url;
    },
    key(event) {
      if (event.key !== "Enter" && event.key !== " ") return;
      this.choose(event);
      event.preventDefault();
    },
    choose(event) {
      const node = event.composedPath().find((each) => each.tagName === "g");
      if (node) this.$emit("pick", node.textContent);
    },
  },
};
