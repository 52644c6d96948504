// Rows of tables that can be clicked are reached by Tab, chosen by Enter or space, and left for their neighbours by arrows.
const ROW = "tbody tr.cursor-pointer";
new MutationObserver(() => document.querySelectorAll(`${ROW}:not([tabindex])`).forEach((row) => (row.tabIndex = 0)))
  .observe(document.documentElement, { childList: true, subtree: true });
document.addEventListener("keydown", (event) => {
  const row = event.target;
  if (!row.matches(ROW)) return;
  const next = { ArrowDown: row.nextElementSibling, ArrowUp: row.previousElementSibling }[event.key];
  if (next) next.focus();
  else if (event.key === "Enter" || event.key === " ") row.click();
  else return;
  event.preventDefault();
});
