// Lines of text that are appended; Vue inserts them as text, never as markup.
export default {
  template: `<div class="fwk-lines" role="log" tabindex="0" @scroll="scrolled">
    <div v-for="line in lines" :key="line[0]" :class="line[1]" :data-tick="line[3]"><a
    v-if="link && line[3] > 0" :href="link + line[3]" :aria-label="'tick ' + line[3] + ' of the recording'">▸</a> {{ line[2] }}</div></div>`,
  props: { most: { type: Number, default: 2000 }, link: String },
  data: () => ({ lines: [], following: true }),
  methods: {
    append(added) {
      this.lines = Object.freeze(this.lines.concat(added).slice(-this.most));
      this.$nextTick(() => { if (this.following) this.$el.scrollTop = this.$el.scrollHeight; });
    },
    clear() { this.lines = []; },
    follow(on) {
      this.following = on;
      if (on) this.$el.scrollTop = this.$el.scrollHeight;
    },
    scrolled() {
      const end = this.$el.scrollHeight - this.$el.clientHeight - this.$el.scrollTop < 30;
      if (end !== this.following) { this.following = end; this.$emit("follow", end); }
    },
  },
};
