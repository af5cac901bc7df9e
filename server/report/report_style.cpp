#include "server/report/report_style.hpp"

namespace repose::server {

// Hues are told apart by the colour-blind (after Okabe & Ito 2008); nothing is said by colour
// alone.
const std::string_view report_style = R"css(
:root {
  color-scheme: light dark;
  --page: #f6f5f2; --sheet: #ffffff; --ink: #1d2329; --quiet: #616b75; --line: #dfe3e6;
  --accent: #1f6f9f; --good: #1b7f6b; --fair: #b7791f; --poor: #c0392b;
  --band-one: #cfe0ea; --band-two: #e8f0f5; --track: #e9ecee; --open: #a4adb5;
  --m0: #8d969e; --m1: #1f78b4; --m2: #12876f; --m3: #8b5fbf;
  --low-1: #d3e5f3; --low-2: #90c0e2; --low-3: #2f7fb9; --high-1: #fbe4cf; --high-2: #f3b375;
  --high-3: #c8641b; --heat-none: #f0f2f3;
  --part: #1d2329; --picture: linear-gradient(#fbfbfa, #e9ebec);
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #14181c; --sheet: #1c2126; --ink: #e7eaec; --quiet: #9aa5ae; --line: #323a41;
    --accent: #6bb6e0; --good: #4fc3a6; --fair: #e0ac4f; --poor: #f0776a;
    --band-one: #2f4a5b; --band-two: #24343f; --track: #2b3238; --open: #6d7780;
    --m0: #8f9aa4; --m1: #63b1e5; --m2: #4fc3a6; --m3: #b795e6;
    --low-1: #22394a; --low-2: #2c5a7d; --low-3: #3f8fca; --high-1: #45331f; --high-2: #7d5423;
    --high-3: #d57c35; --heat-none: #262c32;
    --part: #cfd8df; --picture: linear-gradient(#262c32, #171b1f);
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body {
  margin: 0; background: var(--page); color: var(--ink);
  font: 16px/1.5 system-ui, -apple-system, "Segoe UI", "Helvetica Neue", "DejaVu Sans", sans-serif;
}
main { max-width: 1120px; margin: 0 auto; padding: 28px 16px 56px; }
header p, footer { color: var(--quiet); }
.kind { margin: 0; font-size: 14px; }
h1 { margin: 2px 0 18px; font-size: clamp(22px, 3.4vw, 32px); line-height: 1.2;
     overflow-wrap: anywhere; text-wrap: balance; }
h2 { margin: 0 0 12px; font-size: 18px; line-height: 1.3; }
h3 { margin: 0 0 10px; font-size: 15px; }
.verdict > p + p { margin: 0 0 8px; }
.badge { display: inline-block; min-width: 1.6em; padding: 0 .3em; border-radius: 6px; text-align: center;
  background: var(--accent); color: var(--sheet); }
section, .verdict { background: var(--sheet); border: 1px solid var(--line); border-radius: 10px;
  padding: clamp(14px, 2.4vw, 26px); margin: 16px 0; }
.verdict { border-left: 6px solid var(--good); }
.verdict.met { border-left-color: var(--fair); }
.verdict.missed, .verdict.unfinished { border-left-color: var(--poor); }
.verdict > p:first-child { margin: 0 0 10px; font-size: clamp(18px, 2.4vw, 23px); font-weight: 600;
  line-height: 1.3; }
.verdict ul { margin: 0 0 10px; padding-left: 20px; }
.verdict li { margin: 4px 0; }
.quiet-text { color: var(--quiet); font-size: 14px; margin: 8px 0 0; }
dl.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(130px, 1fr)); gap: 14px 20px;
  margin: 18px 0 0; padding-top: 16px; border-top: 1px solid var(--line); }
.facts dt { color: var(--quiet); font-size: 13px; }
.facts dd { margin: 0; font-size: 19px; font-weight: 600; font-variant-numeric: tabular-nums; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 15px; font-variant-numeric: tabular-nums; }
th, td { padding: 8px 10px; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap;
  vertical-align: baseline; }
th { font-weight: 600; font-size: 13px; color: var(--quiet); }
th:first-child, td:first-child { text-align: left; padding-left: 0; white-space: normal; min-width: 150px; }
th:last-child, td:last-child { padding-right: 0; }
tr:last-child td { border-bottom: 0; }
td small { display: block; color: var(--quiet); font-size: 13px; }
td.good { color: var(--good); font-weight: 600; }
td.fair { color: var(--fair); font-weight: 600; }
td.poor, .warning { color: var(--poor); font-weight: 600; }
td.open { color: var(--quiet); font-style: italic; }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 400px), 1fr)); gap: 28px 40px;
  margin-top: 22px; }
.pair > * { min-width: 0; }
.panels { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 300px), 1fr)); gap: 24px 28px;
  margin-top: 14px; }
.panels > * { min-width: 0; }
.panels .chart { max-width: 360px; }
.half { max-width: 560px; margin-top: 10px; }
.legend { margin: 0 0 6px; font-size: 14px; color: var(--quiet); }
.legend span { display: inline-block; margin-right: 16px; white-space: nowrap; }
.legend i { display: inline-block; width: 12px; height: 12px; margin-right: 6px; border-radius: 50%;
  vertical-align: -1px; }
.legend .m0 { background: var(--m0); } .legend .m1 { background: var(--m1); }
.legend .m2 { background: var(--m2); } .legend .m3 { background: var(--m3); }
.legend .open { border: 2.4px solid var(--quiet); }
.legend .part-one, .legend .part-two, .legend .part-three { border-radius: 2px; background: var(--part); }
.legend .part-one { opacity: .56; } .legend .part-two { opacity: .33; } .legend .part-three { opacity: .16; }
.legend .raw { border-radius: 2px; border: 1.4px solid var(--m1); }
.legend .projected { border-radius: 2px; background: var(--m1); }
.legend .missing { background: var(--high-3); }
.meter { display: block; width: 72px; height: 5px; margin: 3px 0 0 auto; border-radius: 3px; background: var(--track); }
.meter i { display: block; height: 100%; border-radius: 3px; background: var(--accent); }
.ranking td:first-child { max-width: 430px; white-space: normal; }
.ranking .reason { max-width: 52ch; }
td.chip > span { padding: 1px 9px; border-radius: 10px; background: var(--track); font-size: 13px; }
td.supported > span { background: var(--good); color: var(--sheet); font-weight: 600; }
td.outdone > span { background: var(--band-one); }
td.not_testable > span, td.not_probed > span { background: none; color: var(--quiet); font-style: italic; }
figure { margin: 0; max-width: 620px; }
figure img { display: block; width: 100%; height: auto; border-radius: 8px; background: var(--picture); }
figcaption { margin-top: 8px; font-size: 14px; color: var(--quiet); }
figcaption b { color: var(--ink); }
.chart { display: block; width: 100%; max-width: 560px; height: auto; overflow: visible; fill: var(--ink);
  font-family: inherit; }
.wide { overflow-x: auto; }
.wide .chart { max-width: none; min-width: 1020px; }
.chart text { font-size: 13px; }
.chart .label { font-weight: 600; }
.chart .small { font-size: 12px; }
.chart .quiet { fill: var(--quiet); font-size: 12.5px; }
.chart .tick { fill: var(--quiet); font-size: 11.5px; }
.chart .inside { fill: #fff; font-weight: 600; }
.chart .sign { fill: #fff; font-weight: 700; font-size: 14px; pointer-events: none; }
.chart .value.undetermined { fill: var(--quiet); font-style: italic; }
.chart .band.one { fill: var(--band-one); }
.chart .band.two { fill: var(--band-two); }
.chart .axis { stroke: var(--quiet); stroke-width: 1; }
.chart .grid { stroke: var(--line); stroke-width: 1; }
.chart .measured { stroke: var(--ink); stroke-width: 1.6; }
.chart .whisker { stroke: var(--ink); stroke-width: 1.6; }
.chart .dot { stroke: var(--sheet); stroke-width: 1.2; }
.chart .good { fill: var(--good); }
.chart .fair { fill: var(--fair); }
.chart .poor { fill: var(--poor); }
.chart .dot.hollow { fill: var(--sheet); stroke-width: 2.4; }
.chart .hollow.good { stroke: var(--good); }
.chart .hollow.fair { stroke: var(--fair); }
.chart .hollow.poor { stroke: var(--poor); }
.chart .track { fill: var(--track); }
.chart .interval { fill: var(--accent); }
.chart .interval.undetermined { fill: url(#hatch); stroke: var(--open); stroke-width: 1; }
.chart .best { fill: var(--accent); stroke: var(--sheet); stroke-width: 2; }
.chart .best.undetermined { fill: var(--sheet); stroke: var(--open); }
.chart .up { fill: #1f78b4; }
.chart .down { fill: #c8641b; }
.chart .faint { fill-opacity: .6; }
.chart .speck { stroke: var(--accent); stroke-width: 3; stroke-linecap: round; stroke-opacity: .45; }
.chart .expected { stroke: var(--quiet); stroke-dasharray: 4 4; }
.chart .expectation { fill: none; stroke: var(--ink); stroke-width: 1.8; }
.chart .failed { stroke: var(--poor); stroke-width: 1.8; }
.chart .stage { stroke: var(--sheet); stroke-width: .8; fill-opacity: .9; }
.chart .stage.start { fill: #8a949c; }
.chart .stage.replicate { fill: #cc79a7; }
.chart .stage.pair { fill: #8b6fc0; }
.chart .stage.search { fill: #1f8fd0; }
.chart .stage.confirm { fill: #12a37a; }
.chart .part { fill: var(--part); fill-opacity: .16; }
.chart .part.two { fill-opacity: .2; }
.chart .part.one { fill-opacity: .34; }
.chart .m0 { --mark: var(--m0); } .chart .m1 { --mark: var(--m1); }
.chart .m2 { --mark: var(--m2); } .chart .m3 { --mark: var(--m3); }
.chart .model { fill: var(--mark); stroke: var(--sheet); stroke-width: 1.2; }
.chart .model.hollow { fill: var(--sheet); stroke: var(--mark); stroke-width: 2.2; }
.chart .model.hollow.aside { stroke: var(--ink); stroke-width: 1.6; }
.chart .model.faint { fill-opacity: .55; stroke: none; }
.chart .model-line { fill: none; stroke: var(--mark); stroke-width: 1.6; stroke-opacity: .75; }
.chart .floor { stroke: var(--poor); stroke-width: 1.4; stroke-dasharray: 5 4; }
.chart .heat.none { fill: var(--heat-none); } .chart .heat.unknown { fill: none; stroke: var(--line); }
.chart .low.d1 { fill: var(--low-1); } .chart .low.d2 { fill: var(--low-2); } .chart .low.d3 { fill: var(--low-3); }
.chart .high.d1 { fill: var(--high-1); } .chart .high.d2 { fill: var(--high-2); }
.chart .high.d3 { fill: var(--high-3); }
.chart .heat.inside { fill: url(#hatch); fill-opacity: .35; }
.chart .heat-text { font-size: 12.5px; font-variant-numeric: tabular-nums; }
.chart .heat-text.deep { fill: #fff; font-weight: 600; }
.chart .raw { fill: none; stroke: var(--m1); stroke-width: 1.4; }
.chart .projected { fill: var(--m1); }
.chart .missing { fill: var(--high-3); stroke: var(--sheet); stroke-width: 1.2; }
.swatches { position: absolute; width: 0; height: 0; }
details { margin-top: 14px; }
summary { cursor: pointer; color: var(--accent); }
pre { overflow-x: auto; font: 13px/1.45 ui-monospace, "DejaVu Sans Mono", monospace; background: var(--page);
  padding: 12px; border-radius: 8px; }
dl.plain { display: grid; grid-template-columns: minmax(110px, max-content) 1fr; gap: 6px 20px; margin: 0;
  font-size: 15px; }
.plain dt { color: var(--quiet); }
.plain dd { margin: 0; overflow-wrap: anywhere; }
@media (max-width: 600px) {
  main { padding: 18px 10px 40px; }
  tr:first-child { display: none; }
  tr { display: block; padding: 8px 0; border-bottom: 1px solid var(--line); }
  tr:last-child { border-bottom: 0; }
  td { display: flex; justify-content: space-between; gap: 16px; padding: 2px 0; border: 0;
    white-space: normal; }
  td::before { content: attr(data-head); color: var(--quiet); font-weight: 400; font-style: normal;
    white-space: nowrap; }
  td > span { text-align: right; }
  td:first-child { display: block; font-weight: 600; }
  td:first-child small { font-weight: 400; }
  .chart .label { font-size: 14.5px; }
  .chart .label.small { font-size: 13px; }
  .chart .tick { font-size: 13px; }
}
@media print {
  :root { color-scheme: light;
    --page: #fff; --sheet: #fff; --ink: #000; --quiet: #444; --line: #ccc;
    --accent: #1f6f9f; --good: #1b7f6b; --fair: #8f5c10; --poor: #b03024;
    --band-one: #cfe0ea; --band-two: #e8f0f5; --track: #e9ecee; --open: #889; --picture: none; }
  body { font-size: 12px; }
  * { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
  main { max-width: none; padding: 0; }
  section, .verdict { break-inside: avoid; border-radius: 0; padding: 10px 0; border-width: 0 0 1px; }
  .verdict { border-left-width: 6px; padding-left: 12px; }
  section.long { break-inside: auto; }
  figure, tr, .pair > * { break-inside: avoid; }
  details:not([open]) { display: none; }
}
)css";

}  // namespace repose::server
