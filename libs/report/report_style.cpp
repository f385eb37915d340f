// SPDX-License-Identifier: BSD-3-Clause
#include "report/report_sections.h"

namespace psi_slam {

const char* const kReportLogo = R"svg(<svg viewBox="0 0 64 64" aria-hidden="true">
<defs><linearGradient id="dusk" x1="0" y1="0" x2="1" y2="1"><stop offset="0" stop-color="#2f62eb"/><stop offset=".55" stop-color="#8b4de6"/><stop offset="1" stop-color="#e23e8c"/></linearGradient></defs>
<rect width="64" height="64" rx="15" fill="url(#dusk)"/>
<path d="M14 17c6 0 6 5 6 10 0 10 5 14 12 14s12-4 12-14c0-5 0-10 6-10M32 13v38M25 51h14" fill="none" stroke="#fff" stroke-width="4.4" stroke-linecap="round"/>
</svg>)svg";

const char* const kReportStyle = R"css(
:root {
  color-scheme: light dark;
  --page: #f4f5f8; --card: #ffffff; --ink: #1a2130; --soft: #5d6779; --line: #e3e7ee; --ground: #e6e9ef;
  --accent: #3a5bdc; --accent-soft: #3a5bdc26; --good: #0f8a5f; --bad: #cf3434; --warn: #b66a00;
  --shadow: 0 1px 2px #1a213012, 0 4px 16px #1a21300d;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #0e1117; --card: #171b24; --ink: #e7eaf1; --soft: #97a1b4; --line: #283040; --ground: #222938;
    --accent: #8aa2ff; --accent-soft: #8aa2ff30; --good: #45c990; --bad: #ff8080; --warn: #f2b45c;
    --shadow: none;
  }
  .canvas image { filter: invert(.93) hue-rotate(180deg); }
}
* { box-sizing: border-box; }
body {
  margin: 0; padding: 2.2rem 1.2rem 4rem; background: var(--page); color: var(--ink);
  font: 15px/1.5 system-ui, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", "DejaVu Sans", sans-serif;
}
main { max-width: 1180px; margin: 0 auto; }
header { display: flex; gap: 1.1rem; align-items: center; margin-bottom: 1.6rem; }
header svg { flex: none; width: 3.4rem; height: 3.4rem; }
h1 { margin: 0; font-size: 1.75rem; line-height: 1.2; font-weight: 680; letter-spacing: -.015em; overflow-wrap: anywhere; }
header p { margin: .2rem 0 0; color: var(--soft); }
h2 { margin: 0 0 .9rem; font-size: 1.02rem; font-weight: 650; letter-spacing: -.005em; }
h2 small { color: var(--soft); font-weight: 400; font-size: .86rem; margin-left: .5rem; }
section { margin-bottom: 1.2rem; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 14px; padding: 1.15rem 1.3rem; box-shadow: var(--shadow); }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(26rem, 100%), 1fr)); gap: 1.2rem; }
.banner { border-left: 4px solid var(--warn); }
.tiles { display: grid; grid-template-columns: repeat(4, 1fr); gap: .8rem; }
.tile { background: var(--card); border: 1px solid var(--line); border-radius: 14px; padding: .85rem 1.1rem .8rem; box-shadow: var(--shadow); }
.tile h3 { margin: 0; font-size: .8rem; font-weight: 550; color: var(--soft); }
.tile .figure { margin: .1rem 0 .05rem; font-size: 1.85rem; line-height: 1.2; font-weight: 660; letter-spacing: -.02em; font-variant-numeric: tabular-nums; }
.tile .figure small { font-size: .95rem; font-weight: 500; color: var(--soft); letter-spacing: 0; }
.tile .note { margin: 0; font-size: .82rem; color: var(--soft); }
.map { display: flex; flex-wrap: wrap; gap: .5rem; }
.map > input { position: absolute; opacity: 0; pointer-events: none; }
.map > label {
  display: inline-flex; align-items: center; gap: .45rem; padding: .22rem .75rem .22rem .6rem; border: 1px solid var(--line);
  border-radius: 99px; font-size: .84rem; cursor: pointer; user-select: none; color: var(--soft);
}
.map > label::before { content: ""; width: .7rem; height: .7rem; border-radius: 50%; border: 2px solid var(--mark); }
.map > input:checked + label { color: var(--ink); background: var(--accent-soft); border-color: transparent; }
.map > input:checked + label::before { background: var(--mark); }
.map > input:focus-visible + label { outline: 2px solid var(--accent); outline-offset: 2px; }
label[for=show-grid] { --mark: var(--ink); }
label[for=show-trajectory] { --mark: #b146c2; }
label[for=show-accepted] { --mark: var(--good); }
label[for=show-refused] { --mark: var(--bad); }
label[for=show-switched-off] { --mark: var(--warn); }
label[for=show-front-end] { --mark: #1c9fb8; }
label[for=show-odometry] { --mark: #8b93a3; }
#show-grid:not(:checked) ~ .canvas .grid, #show-trajectory:not(:checked) ~ .canvas .trajectory,
#show-accepted:not(:checked) ~ .canvas .accepted, #show-refused:not(:checked) ~ .canvas .refused,
#show-switched-off:not(:checked) ~ .canvas .switched-off, #show-front-end:not(:checked) ~ .canvas .front-end,
#show-odometry:not(:checked) ~ .canvas .odometry { display: none; }
.canvas { flex: 1 0 100%; max-height: 82vh; margin-top: .35rem; background: var(--ground); border-radius: 10px; overflow: hidden; }
.canvas svg { display: block; width: 100%; height: 100%; cursor: grab; touch-action: pan-y; }
.canvas svg.moving { cursor: grabbing; }
.canvas path { fill: none; stroke-linejoin: round; stroke-linecap: round; vector-effect: non-scaling-stroke; }
.trajectory path { stroke-width: 2px; }
.trajectory path.rim { stroke: #fff; stroke-width: 16px; }
.trajectory path.start { stroke: #2f62eb; stroke-width: 11px; }
.trajectory path.end { stroke: #f77e18; stroke-width: 11px; }
.odometry path { stroke: #8b93a3; stroke-width: 1.3px; }
.front-end path { stroke: #1c9fb8; stroke-width: 1.3px; }
.loop path { stroke-width: 1.3px; opacity: .5; }
.loop path:hover { stroke-width: 6px; opacity: 1; }
.accepted path { stroke: var(--good); }
.refused path { stroke: var(--bad); opacity: .45; }
.switched-off path { stroke: var(--warn); opacity: .9; }
.scale path { stroke: var(--ink); stroke-width: 1.5px; stroke-linecap: butt; }
.scale text { fill: var(--ink); font-weight: 550; }
.legend { flex: 1 0 100%; margin: .1rem 0 0; font-size: .83rem; color: var(--soft); }
.legend b { font-weight: 600; color: var(--ink); }
.ramp { display: inline-block; width: 5.5rem; height: .45rem; border-radius: 9px; vertical-align: .06rem; margin-right: .35rem;
  background: linear-gradient(90deg, #2f62eb, #8b4de6, #e23e8c, #f77e18); }
.hint { float: right; }
.plot { display: block; width: 100%; height: auto; }
.plot text { font-size: 12.5px; fill: var(--soft); font-variant-numeric: tabular-nums; }
.plot text.value { text-anchor: end; }
.plot text.time { text-anchor: middle; }
.plot text.limit { text-anchor: end; fill: var(--warn); }
.plot text.limit.early { text-anchor: start; }
.plot path { fill: none; }
.plot path.rule { stroke: var(--line); }
.plot path.band { fill: var(--accent-soft); }
.plot path.mean { stroke: var(--accent); stroke-width: 1.6; stroke-linejoin: round; }
.plot path.matcher { opacity: .85; }
.plot path.matcher.csm { fill: #3a7bd5; } .plot path.matcher.csm_ga { fill: #9a5be0; } .plot path.matcher.ga { fill: #e2508f; }
.key.matcher { height: .7rem; vertical-align: -.02rem; opacity: .85; }
.key.csm { background: #3a7bd5; } .key.csm_ga { background: #9a5be0; } .key.ga { background: #e2508f; }
.plot path.closed { stroke: var(--good); stroke-width: 2; }
.plot path.limit { stroke: var(--warn); stroke-width: 1.3; stroke-dasharray: 6 5; }
.key { display: inline-block; width: .95rem; height: .2rem; border-radius: 2px; vertical-align: .22rem; margin: 0 .3rem 0 .9rem; background: var(--accent); }
.key.range { height: .7rem; vertical-align: -.02rem; background: var(--accent-soft); }
.key.loops { width: .2rem; height: .7rem; vertical-align: -.02rem; background: var(--good); }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
.facts { width: 100%; font-size: .9rem; }
.facts caption { text-align: left; font-weight: 650; padding: .2rem 0; }
.facts th { text-align: left; font-weight: 450; color: var(--soft); padding: .28rem 1rem .28rem 0; white-space: nowrap; vertical-align: top; }
.facts td { padding: .28rem 0; overflow-wrap: anywhere; }
.facts tr + tr { border-top: 1px solid var(--line); }
.wide { overflow-x: auto; }
.tall { max-height: 34rem; overflow-y: auto; margin-top: .8rem; }
.rows { width: 100%; font-size: .88rem; }
.rows th, .rows td { padding: .38rem .7rem; text-align: right; white-space: nowrap; border-top: 1px solid var(--line); }
.rows thead th { font-weight: 500; color: var(--soft); border-top: 0; position: sticky; top: 0; background: var(--card); }
.rows th:first-child, .rows td:first-child { text-align: left; padding-left: 0; font-weight: 550; }
.rows th:last-child, .rows td:last-child { padding-right: 0; }
.rows .text { text-align: left; white-space: normal; min-width: 16rem; color: var(--soft); }
.share { position: relative; min-width: 11rem; }
.share b { font-weight: 500; position: relative; }
.share .bar { position: absolute; left: .7rem; top: 50%; height: .95rem; margin-top: -.47rem; max-width: calc(100% - 4.6rem); }
.bar { display: inline-block; background: var(--accent); opacity: .75; border-radius: 4px; }
.bars { width: 100%; font-size: .9rem; margin: .7rem 0 .9rem; }
.bars td { padding: .3rem 0; }
.bars .number { text-align: right; padding-right: .8rem; font-weight: 600; width: 1%; vertical-align: bottom; }
.bars .bar { display: block; height: .35rem; opacity: .8; margin-bottom: .1rem; }
.bar.bad { background: var(--bad); }
.badge { font-size: .78rem; font-weight: 600; padding: .08rem .55rem; border-radius: 99px; border: 1px solid currentColor; }
.badge.good { color: var(--good); } .badge.bad { color: var(--bad); } .badge.warn { color: var(--warn); }
details summary { cursor: pointer; color: var(--accent); font-weight: 550; }
.settings { columns: 2 22rem; column-gap: 2.4rem; margin-top: .8rem; }
.settings th { width: 55%; }
.settings table { break-inside: avoid; margin-bottom: 1rem; }
code { font: .86rem ui-monospace, "Cascadia Mono", "DejaVu Sans Mono", monospace; }
.none { color: var(--soft); margin: .4rem 0 0; }
.files { list-style: none; margin: 0; padding: 0; display: grid; grid-template-columns: repeat(auto-fill, minmax(17rem, 1fr)); gap: .3rem 1.4rem; font-size: .9rem; }
.files span { color: var(--soft); }
a { color: var(--accent); text-decoration: none; } a:hover { text-decoration: underline; }
@media (max-width: 900px) { .tiles { grid-template-columns: repeat(2, 1fr); } }
@media (max-width: 640px) { .hint { display: none; } body { padding: 1.2rem .7rem 3rem; } .card { padding: .9rem; } }
@media print { body { background: #fff; } .card, .tile { box-shadow: none; break-inside: avoid; } .hint { display: none; } }
)css";

const char* const kReportScript = R"js(
(function () {
  'use strict';
  var svg = document.getElementById('map');
  if (!svg) return;
  var home = svg.getAttribute('viewBox').split(' ').map(Number), view = home.slice();
  function show(box) { view = box; svg.setAttribute('viewBox', box.join(' ')); }
  function here(event) {
    var p = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    return [p.x, p.y];
  }
  function all() {
    var box = [home[0], home[1], home[0] + home[2], home[1] + home[3]];
    document.querySelectorAll('.map > input[data-view]:checked').forEach(function (input) {
      var v = input.dataset.view.split(' ').map(Number);
      box = [Math.min(box[0], v[0]), Math.min(box[1], v[1]), Math.max(box[2], v[0] + v[2]), Math.max(box[3], v[1] + v[3])];
    });
    return [box[0], box[1], box[2] - box[0], box[3] - box[1]];
  }
  document.querySelectorAll('.map > input[data-view]').forEach(function (input) {
    input.addEventListener('change', function () { show(all()); });
  });
  svg.addEventListener('wheel', function (event) {
    event.preventDefault();
    var scale = Math.pow(1.0015, event.deltaY), at = here(event), width = view[2] * scale;
    if (width > 8 * home[2] || width < home[2] / 80) return;
    show([at[0] + (view[0] - at[0]) * scale, at[1] + (view[1] - at[1]) * scale, width, view[3] * scale]);
  }, { passive: false });
  var grip = null;
  svg.addEventListener('pointerdown', function (event) { grip = here(event); svg.setPointerCapture(event.pointerId); svg.classList.add('moving'); });
  svg.addEventListener('pointermove', function (event) {
    if (!grip) return;
    var at = here(event);
    show([view[0] + grip[0] - at[0], view[1] + grip[1] - at[1], view[2], view[3]]);
  });
  ['pointerup', 'pointercancel'].forEach(function (name) {
    svg.addEventListener(name, function () { grip = null; svg.classList.remove('moving'); });
  });
  svg.addEventListener('dblclick', function () { show(all()); });
})();
)js";

}  // namespace psi_slam
