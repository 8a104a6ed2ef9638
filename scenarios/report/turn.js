// The drawing of a report that can be turned: a function of the probe's path (path.cpp), called once. It draws into the page's one
// element of class "turn", in units of 300 across, without anything from outside the page. Angles: `yaw` turns the viewer
// about the patient's long axis from where the face is seen, `pitch` lifts the viewer towards the head.
(probePath => {
  const view = document.querySelector('svg.turn');
  const scale = 126 / Math.max(20, Math.hypot(...probePath.half));
  let yaw = -0.6, pitch = 0.45;
  const draw = () => {
    const [cy, sy, cp, sp] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
    const at = (x, y, z) => [150 + scale * (cy * x + sy * y), 176 - scale * (cp * z + sp * (cy * y - sy * x))];
    const path = (kind, points) => `<path class='${kind}' d='M${points.map(p => p.map(v => v.toFixed(1)).join(' ')).join('L')}'/>`;
    const away = (x, y, z) => cp * (cy * y - sy * x) - sp * z;
    const [a, b, c] = probePath.half.map(h => Math.max(h, 1));
    let svg = "<rect class='frame' x='0' y='26' width='300' height='300'/><text class='name' x='0' y='18'>In space</text>"
      + "<text class='tick hint' x='300' y='18' text-anchor='end'>drag to turn</text>";
    for (const s of [-1, 1]) for (const t of [-1, 1])
      svg += path('edge', [at(-a, s * b, t * c), at(a, s * b, t * c)]) + path('edge', [at(s * a, -b, t * c), at(s * a, b, t * c)])
        + path('edge', [at(s * a, t * b, -c), at(s * a, t * b, c)]);
    const far = 12 / scale;
    const words = [['R', -a - far, 0, 0], ['L', a + far, 0, 0], ['head', 0, 0, c + far], ['feet', 0, 0, -c - far],
      ['front', 0, -b - far, 0], ['back', 0, b + far, 0]].sort((one, other) => away(...one.slice(1)) - away(...other.slice(1)));
    const written = [];
    for (const [text, ...where] of words) {
      // One that another hides lies behind it.
      const p = at(...where);
      if (written.some(q => Math.abs(p[0] - q[0]) < 24 && Math.abs(p[1] - q[1]) < 12)) continue;
      written.push(p);
      svg += `<text class='tick' text-anchor='middle' x='${p[0]}' y='${p[1] + 4}'>${text}</text>`;
    }
    for (const [kind, ...v] of probePath.stretches) {
      const points = [];
      for (let i = 0; i < v.length; i += 3) points.push(at(v[i], v[i + 1], v[i + 2]));
      svg += path('path path' + kind, points);
    }
    const dot = (kind, r, p) => `<circle class='${kind}' r='${r}' cx='${p[0].toFixed(1)}' cy='${p[1].toFixed(1)}'/>`;
    svg += dot('start', 4, at(...probePath.start));
    for (const [x, y, z, held] of probePath.spots) svg += dot('spot ' + (held ? 'good' : 'bad'), 5, at(x, y, z));
    view.innerHTML = svg;
  };
  view.addEventListener('pointerdown', e => view.setPointerCapture(e.pointerId));
  view.addEventListener('pointermove', e => {
    if (!e.buttons) return;
    yaw -= e.movementX * 0.01;
    pitch = Math.max(-1.57, Math.min(1.57, pitch + e.movementY * 0.01));
    draw();
  });
  draw();
})
