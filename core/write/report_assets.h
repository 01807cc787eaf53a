#pragma once

#include <string_view>

namespace citymesh {

// Style and script of report.html, inlined: the page stands alone.

inline constexpr std::string_view kReportStyle = R"css(
:root{color-scheme:light dark;--bg:#f4f5f7;--card:#fff;--ink:#1f2733;--soft:#5c6878;--line:#e1e5ea;
--accent:#2f6f8f;--track:#edf0f3;--chip:#f1f3f6;--warn-bg:#fff6e2;--warn:#7a5200;--bad:#b3402a}
@media (prefers-color-scheme:dark){:root{--bg:#13171d;--card:#1c222b;--ink:#e4e8ee;--soft:#98a4b3;
--line:#2d3541;--accent:#7cbcdb;--track:#29313c;--chip:#29313c;--warn-bg:#332a14;--warn:#f0c674;--bad:#f0907a}}
*{box-sizing:border-box}
body{margin:0;background:var(--bg);color:var(--ink);
font:15px/1.5 system-ui,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;font-variant-numeric:tabular-nums}
main,header{max-width:1240px;margin:0 auto;padding:0 24px}
header{padding-top:36px;padding-bottom:8px}
h1{font-size:30px;line-height:1.2;margin:0 0 6px;letter-spacing:-.01em}
h2{font-size:17px;margin:0 0 12px}
.lead{font-size:17px;margin:0;max-width:60em}
.meta{color:var(--soft);margin:8px 0 0;font-size:13.5px}
section{background:var(--card);border:1px solid var(--line);border-radius:12px;padding:20px 22px;margin:16px 0}
.pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(340px,1fr));gap:16px;margin:16px 0}
.pair section{margin:0}
.numbers{display:grid;grid-template-columns:repeat(auto-fit,minmax(150px,1fr));gap:18px;margin-bottom:16px}
.numbers b{display:block;font-size:36px;line-height:1.1;font-weight:650;letter-spacing:-.02em}
.numbers span{color:var(--soft)}
.zero b{color:var(--soft);font-weight:400}
.share{display:flex;height:12px;border-radius:6px;overflow:hidden;background:var(--track);gap:2px}
.share i{display:block;min-width:3px}
.facts{display:flex;flex-wrap:wrap;gap:4px 26px;margin:14px 0 0;color:var(--soft)}
.facts b{color:var(--ink);font-weight:600}
.bars{display:grid;grid-template-columns:1fr max-content;gap:2px 14px;align-items:baseline;margin:0}
.bars dt{font-weight:600}.bars dt small{font-weight:400;color:var(--soft);margin-left:8px}
.bars dd{margin:0}.bars .n{text-align:right}
.bars .bar{grid-column:1/-1;height:10px;border-radius:4px;background:var(--track);overflow:hidden;margin-bottom:9px}
.bar i{display:block;height:100%;min-width:3px;border-radius:4px;background:var(--accent)}
.asked{display:grid;grid-template-columns:max-content 1fr;gap:4px 18px;margin:0}
.asked dt{color:var(--soft)}.asked dd{margin:0;overflow-wrap:anywhere}
.none{color:var(--soft)}
ul.plain{list-style:none;margin:0;padding:0}ul.plain li{padding:4px 0}
.warnings{background:var(--warn-bg);border-color:transparent;color:var(--warn)}
.warnings ul{margin:0;padding-left:20px}
figure{margin:16px 0;border:1px solid var(--line);border-radius:12px;overflow:hidden}
figure svg{display:block;width:100%;height:auto}
.gallery .grid{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,500px),1fr));gap:16px;margin-top:14px}
.gallery figure{margin:0}.gallery svg{background:#eef1f5}
.gallery figcaption{padding:10px 14px 12px;font-size:13.5px;line-height:1.7}
.gallery figcaption small{color:var(--soft);display:block;line-height:1.45}
.gallery .id{overflow-wrap:anywhere}.gallery details{margin-top:14px}summary{cursor:pointer;color:var(--accent)}
.ba circle{fill:#d3312b;fill-opacity:.85;stroke:#fff;stroke-width:1.2}.ba .cut{stroke:#c3cad4;fill:none}
.keys{display:flex;flex-wrap:wrap;gap:4px 18px;margin:8px 0 0;font-size:13px;color:var(--soft)}
.keys i{display:inline-block;width:11px;height:11px;border-radius:3px;margin-right:6px}
a{color:var(--accent)}
.controls{display:flex;flex-wrap:wrap;gap:10px 14px;align-items:center;margin-bottom:12px}
.controls input[type=search],.controls select{font:inherit;color:inherit;background:var(--bg);
border:1px solid var(--line);border-radius:8px;padding:6px 10px}
.controls input[type=search]{flex:1 1 240px;max-width:380px}
.controls output{color:var(--soft);margin-left:auto}
.scroll{overflow-x:auto;margin:0 -22px -20px;border-top:1px solid var(--line)}
table{border-collapse:collapse;width:100%;font-size:13.5px}
th,td{text-align:left;padding:7px 12px;border-bottom:1px solid var(--line);vertical-align:top}
th:first-child,td:first-child{padding-left:22px}th:last-child,td:last-child{padding-right:22px}
tbody tr:last-child td{border-bottom:0}
tbody tr:hover{background:var(--chip)}
thead th{position:sticky;top:0;background:var(--card);white-space:nowrap;font-weight:600;color:var(--soft)}
.num{text-align:right;white-space:nowrap}
th button{all:unset;cursor:pointer}th button:focus-visible{outline:2px solid var(--accent);outline-offset:2px}
th button::after{content:"";display:inline-block;width:1em;text-align:center}
th[aria-sort=ascending] button::after{content:"\2191"}th[aria-sort=descending] button::after{content:"\2193"}
td .id{font-weight:600;overflow-wrap:anywhere}
td small{color:var(--soft);display:block}
td small.bad{color:var(--bad)}
.rung{display:inline-block;padding:1px 9px;border-radius:10px;color:#1f2733;white-space:nowrap;font-size:12.5px}
.rung.dropped{background:transparent;color:var(--bad);border:1px solid currentColor}
.rung.merged{background:transparent;color:var(--soft);border:1px solid currentColor}
.issue{display:inline-block;margin:0 6px 3px 0;padding:1px 7px;border-radius:6px;background:var(--chip);
text-decoration:none;cursor:help;font-size:12.5px}
.issue b{font-weight:650}
tbody tr:hover .issue{background:var(--card)}
footer{color:var(--soft);font-size:13px;max-width:1240px;margin:0 auto;padding:6px 24px 44px}
@media print{:root{color-scheme:light;--bg:#fff;--card:#fff;--ink:#000;--soft:#444;--line:#ccc;--chip:#f1f3f6;--track:#eee}
body{font-size:11px}section,figure{break-inside:avoid;border-radius:0}.table{break-inside:auto}
.controls{display:none!important}thead th{position:static}tr{break-inside:avoid}.scroll{overflow:visible}
.rung,.bar i,.share i,.issue{print-color-adjust:exact;-webkit-print-color-adjust:exact}}
)css";

inline constexpr std::string_view kReportScript = R"js(
(function () {
  const table = document.getElementById('buildings');
  if (!table) return;
  const body = table.tBodies[0], rows = Array.from(body.rows);
  const search = document.getElementById('search'), rung = document.getElementById('rung');
  const defects = document.getElementById('defects'), shown = document.getElementById('shown');
  const texts = rows.map(row => row.textContent.toLowerCase());
  const kinds = new Set(rows.map(row => row.dataset.kind));
  for (const kind of Array.from(kinds).sort()) {
    const option = document.createElement('option');
    option.textContent = kind;
    rung.append(option);
  }
  function filter() {
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let count = 0;
    rows.forEach((row, i) => {
      const show = words.every(word => texts[i].includes(word)) &&
        (!rung.value || row.dataset.kind === rung.value) &&
        (!defects.checked || row.dataset.issues !== '0');
      row.hidden = !show;
      if (show) ++count;
    });
    shown.textContent = count + ' of ' + rows.length + ' shown';
  }
  function key(row, column) {
    const cell = row.cells[column], value = cell.dataset.v;
    return value === undefined ? cell.textContent.trim().toLowerCase() : Number(value);
  }
  table.tHead.addEventListener('click', event => {
    const button = event.target.closest('button');
    if (!button) return;
    const head = button.parentElement, column = head.cellIndex;
    const numeric = head.classList.contains('num');
    const was = head.getAttribute('aria-sort');
    const down = was ? was === 'ascending' : numeric;
    for (const other of table.tHead.rows[0].cells) other.removeAttribute('aria-sort');
    head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
    const order = rows.map((row, i) => [key(row, column), i]);
    order.sort((a, b) => (a[0] < b[0] ? -1 : a[0] > b[0] ? 1 : 0) * (down ? -1 : 1) || a[1] - b[1]);
    body.append(...order.map(entry => rows[entry[1]]));
  });
  for (const control of [search, rung, defects]) control.addEventListener('input', filter);
  document.querySelector('.controls').hidden = false;
  filter();
})();
)js";

}  // namespace citymesh
