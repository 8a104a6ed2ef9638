#pragma once

namespace insonate {

/// The report's look: one quiet column, on a screen and on paper.
inline constexpr char kReportStyle[] = R"css(
:root { --ink: #1d2733; --quiet: #5f6c7b; --line: #e3e8ee; --good: #1f7a4d; --bad: #b3362b; --some: #b07a10;
  --blue: #2567a8; }
* { box-sizing: border-box; }
body { margin: 0; background: #f5f7f9; color: var(--ink); font: 15px/1.5 Inter, system-ui, sans-serif;
  -webkit-print-color-adjust: exact; print-color-adjust: exact; }
main { max-width: 860px; margin: 0 auto; padding: 40px 24px 64px; }
header { display: flex; justify-content: space-between; gap: 24px; align-items: flex-end; }
.whose { width: auto; font-size: 13px; }
.whose td { border: 0; padding: 1px 0 1px 16px; white-space: nowrap; }
.whose td:first-child { color: var(--quiet); }
header h1 { margin: 2px 0; font-size: 28px; line-height: 1.25; letter-spacing: -0.01em; }
header p { margin: 0; }
h2 { margin: 0 0 6px; font-size: 18px; display: flex; align-items: center; gap: 10px; }
.quiet, .legend { color: var(--quiet); font-size: 13px; margin: 0 0 12px; }
section, .verdict { background: #fff; border: 1px solid var(--line); border-radius: 10px; padding: 20px 24px;
  margin-top: 18px; break-inside: avoid; }
.verdict { border-left: 6px solid var(--quiet); }
.verdict.passed { border-left-color: var(--good); }
.verdict.failed { border-left-color: var(--bad); }
.verdict > div:first-child { display: flex; justify-content: space-between; align-items: baseline; }
.verdict strong { font-size: 24px; }
.passed strong { color: var(--good); }
.failed strong { color: var(--bad); }
.percent { font-size: 32px; font-weight: 600; font-variant-numeric: tabular-nums; }
.percent small { font-size: 18px; font-weight: 400; }
.verdict p { margin: 8px 0 0; color: var(--quiet); }
.verdict ul { margin: 12px 0 0; padding-left: 20px; }
.verdict li { margin: 4px 0; }
.meter { position: relative; height: 10px; border-radius: 5px; background: #e9edf1; margin-top: 10px; }
.meter i { display: block; height: 100%; border-radius: 5px; background: var(--quiet); }
.passed .meter i { background: var(--good); }
.failed .meter i { background: var(--bad); }
.meter b { position: absolute; top: -4px; height: 18px; width: 2px; background: var(--ink); }
.outcome { font-size: 12px; font-weight: 500; padding: 2px 10px; border-radius: 10px; background: #f0f2f5; }
.outcome.good { color: var(--good); background: #e8f4ed; }
.outcome.bad { color: var(--bad); background: #fbeceb; }
table { border-collapse: collapse; width: 100%; }
th { text-align: left; font-size: 12px; font-weight: 500; color: var(--quiet); padding: 6px 0; }
td { border-top: 1px solid var(--line); padding: 9px 0; vertical-align: top; }
td b { font-weight: 600; }
td small { display: block; color: var(--quiet); font-size: 13px; max-width: 30em; }
.number { text-align: right; padding-left: 18px; white-space: nowrap; font-variant-numeric: tabular-nums; }
.marks { table-layout: fixed; }
.marks th:nth-child(2) { width: 96px; }
.marks th:nth-child(3) { width: 180px; }
.marks th:nth-child(4) { width: 112px; }
.critical { font-size: 11px; color: var(--bad); border: 1px solid currentColor; border-radius: 8px; padding: 0 7px; }
.bar { width: 84px; height: 4px; margin: 5px 0 0 auto; border-radius: 2px; background: #e9edf1; }
.bar i { display: block; height: 100%; border-radius: 2px; background: var(--some); }
.bar.all i { background: var(--good); }
tr.none td.number:last-child { color: var(--bad); }
.overview { margin-top: 14px; font-size: 14px; }
.overview td { padding: 6px 0; vertical-align: middle; }
.overview td:nth-child(2) { text-align: right; }
.overview td:nth-child(3) { width: 90px; }
.overview td:nth-child(4) { width: 130px; }
.pictures { display: flex; gap: 16px; margin-top: 14px; break-inside: avoid; }
figure { margin: 0; flex: 1 1 0; }
figure img { width: 100%; border-radius: 6px; background: #000; display: block; }
.missing { aspect-ratio: 10 / 7; display: flex; align-items: center; justify-content: center; border-radius: 6px;
  border: 1px dashed var(--quiet); color: var(--quiet); font-size: 13px; }
figcaption { color: var(--quiet); font-size: 13px; margin-top: 6px; }
.chart { width: 100%; height: auto; display: block; }
.chart text { font: 11px Inter, system-ui, sans-serif; fill: var(--quiet); }
.chart .name { font-size: 12px; font-weight: 600; fill: var(--ink); }
.grid { stroke: var(--line); }
.curve { fill: none; stroke: var(--blue); stroke-width: 1.6; stroke-linejoin: round; }
.held { fill: #bfe3cd; background: #bfe3cd; }
.judged { fill: #f6cfcb; background: #f6cfcb; }
.lost { fill: #d5dae0; background: #d5dae0; }
.step { stroke: var(--quiet); stroke-dasharray: 2 3; }
.full { stroke: var(--good); stroke-dasharray: 6 4; }
.frame { fill: #fbfcfd; stroke: var(--line); }
.way { fill: none; stroke-width: 1.4; stroke-linejoin: round; opacity: 0.85; }
.way0 { stroke: #2567a8; } .way1 { stroke: #c2671b; } .way2 { stroke: #6d4ea3; } .way3 { stroke: #2b7f7a; }
.start { fill: var(--quiet); }
.spot { stroke: #fff; stroke-width: 1.5; }
.spot.good { fill: var(--good); }
.spot.bad { fill: var(--bad); }
.paths { display: flex; gap: 2%; }
.paths .chart { flex: 622 1 0; min-width: 0; } /* as wide as they draw, so that both come out equally high */
.paths .turn { flex: 302 1 0; cursor: grab; touch-action: none; user-select: none; }
.edge { fill: none; stroke: var(--line); }
.ruler { stroke: var(--quiet); stroke-width: 2; }
.legend { margin: 10px 0 0; }
.key { display: inline-block; width: 14px; height: 10px; margin: 0 6px 0 12px; border-radius: 2px; }
.key:first-child { margin-left: 0; }
.key.full { height: 0; border-top: 2px dashed var(--good); vertical-align: middle; }
.key.way0 { background: #2567a8; } .key.way1 { background: #c2671b; }
.key.way2 { background: #6d4ea3; } .key.way3 { background: #2b7f7a; }
.origin { font-size: 13px; color: var(--quiet); }
.origin td { padding: 4px 0; border: 0; }
.origin td:first-child { width: 130px; }
code { font: 12px ui-monospace, monospace; }
@media print {
  body { background: #fff; font-size: 12px; }
  main { padding: 0; max-width: none; }
  section, .verdict { margin-top: 10px; padding: 12px 16px; }
  header h1 { font-size: 22px; }
  td { padding: 5px 0; }
  .pictures figure img { max-height: 62mm; object-fit: contain; }
  section > .chart { width: 80%; margin: 0 auto; }
  .origin td { padding: 2px 0; }
  .hint { display: none; }
  @page { size: A4; margin: 12mm; }
}
)css";

}  // namespace insonate
