// Sound and its place in the pictures.
for (const trial of document.querySelectorAll("details.trial")) {
  const [audio, svg] = [trial.querySelector("audio"), trial.querySelector("svg")];
  if (!audio || !svg) continue;
  const fromS = Number(trial.dataset.soundFromS);
  const cursors = svg.panels.filter((panel) => panel.isTime).map((panel) => {
    const lines = ["cursor edge", "cursor"].map((name) => make("line", { class: `${name} hidden`, y1: panel.top, y2: panel.bottom }, svg));
    return { panel, lines };
  });
  svg.moveCursors = () => {
    const time = fromS + audio.currentTime;
    const isSilent = audio.currentTime === 0 && audio.paused;
    for (const { panel, lines } of cursors) {
      const isOutside = time < panel.view.xFrom || time > panel.view.xTo;
      for (const line of lines) {
        line.classList.toggle("hidden", isSilent || isOutside);
        line.setAttribute("x1", panel.px(time));
        line.setAttribute("x2", panel.px(time));
      }
    }
  };
  svg.seek = (timeS) => {
    audio.currentTime = Math.max(timeS - fromS, 0);
    audio.play().catch(() => {});
  };
  const follow = () => {
    svg.moveCursors();
    if (!audio.paused) requestAnimationFrame(follow);
  };
  for (const event of ["play", "seeked", "pause", "timeupdate"]) audio.addEventListener(event, follow);
  audio.addEventListener("play", () => {
    for (const other of document.querySelectorAll("audio")) if (other !== audio) other.pause();
  });
}
