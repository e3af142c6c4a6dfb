"""The style sheet of HTML reports: for wide and narrow screens, dark mode and A4 paper."""

STYLE = """
:root { --ink: #1c1c1e; --soft: #5f6368; --line: #d0d4da; --paper: #ffffff; --tint: #f5f6f8;
  --link: #1a4f9c; color-scheme: light dark; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e6e8; --soft: #a5aab2; --line: #454a52;
  --paper: #16181b; --tint: #1f2226; --link: #8ab4f8; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 1rem/1.55 "Source Serif 4", Charter, "Bitstream Charter", Cambria, Georgia, serif; }
main { max-width: 52rem; margin: 0 auto; padding: 1.5rem 1.25rem 4rem; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 1rem 0 0.5rem; }
h2 { font-size: 1.4rem; margin: 2.6rem 0 0.6rem; padding-top: 0.8rem; border-top: 1px solid var(--line); }
h3 { font-size: 1.1rem; margin: 1.6rem 0 0.4rem; }
h1, h2, h3, h4 { overflow-wrap: anywhere; }
.n { color: var(--soft); font-weight: normal; }
.about { font-size: 1.1rem; color: var(--soft); }
p { margin: 0.6rem 0; overflow-wrap: break-word; }
a { color: var(--link); text-decoration: none; }
a:hover { text-decoration: underline; }
nav { columns: 16rem; column-gap: 2rem; margin: 1.5rem 0; padding: 0.8rem 1.1rem;
  background: var(--tint); border-radius: 0.4rem; font-size: 0.92rem; line-height: 1.4; }
nav ol, nav ul { margin: 0; padding-left: 1.4rem; }
nav ul { list-style: none; padding-left: 0.4rem; }
nav ol > li { break-inside: avoid; margin-bottom: 0.25rem; }
code { font: 0.86em/1.4 ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace; }
math { font-family: "STIX Two Math", "Latin Modern Math", "Cambria Math", math; font-size: 1.06em; }
math .w { font-family: "STIX Two Text", "Latin Modern Roman", "Times New Roman", serif;
  font-style: italic; }
math .b { font-weight: bold; }
.eqs { margin: 0.7rem 0; padding: 0.15rem 0 0.15rem 1.2rem; overflow-x: auto; overflow-y: hidden; }
.eqs p { margin: 0.35rem 0; padding-left: 2.4rem; text-indent: -2.4rem; line-height: 1.75; }
.eqs math { text-indent: 0; }
.wide { overflow-x: auto; margin: 0.8rem 0; }
table { border-collapse: collapse; font-size: 0.92rem; line-height: 1.4; }
th, td { text-align: left; vertical-align: baseline; padding: 0.28rem 0.9rem 0.28rem 0; }
thead th { border-bottom: 1.5px solid var(--ink); font-weight: 600; vertical-align: bottom; }
tbody tr + tr > * { border-top: 1px solid var(--line); }
table.matrix { font-size: 0.82rem; }
table.matrix td { text-align: center; padding: 0.15rem 0.3rem; min-width: 1.6rem;
  font-variant-numeric: tabular-nums; }
table.matrix thead th { vertical-align: bottom; padding: 0.2rem 0; border-bottom: 1.5px solid var(--ink);
  text-align: center; }
table.matrix thead th span { writing-mode: vertical-rl; transform: rotate(180deg); white-space: nowrap;
  font-weight: normal; display: inline-block; }
table.matrix tbody th { font-weight: normal; white-space: nowrap; padding-right: 0.7rem; }
.sums p { margin: 0.15rem 0 0.15rem 1.2rem; text-indent: -1.2rem; font-size: 0.88rem; }
.listing { font-size: 0.95rem; }
.listing .label { break-after: avoid; margin: 0.9rem 0 0.1rem; font-style: italic; color: var(--soft); }
.listing .eqs { margin: 0; padding-left: 0; columns: 21rem; column-gap: 1.5rem; }
.listing .eqs p { break-inside: avoid; margin: 0.1rem 0; }
figure { margin: 1rem 0; text-align: center; }
figure svg { max-width: 100%; height: auto; background: #ffffff; border-radius: 0.3rem; }
figcaption { color: var(--soft); font-size: 0.9rem; }
footer { margin-top: 3rem; padding-top: 0.6rem; border-top: 1px solid var(--line); color: var(--soft);
  font-size: 0.8rem; overflow-wrap: anywhere; }
.many { columns: 19rem; column-gap: 1.5rem; }
.many p { break-inside: avoid; }
@media (max-width: 40rem) { td:has(code) { min-width: 7.5rem; }
  main { padding: 0.8rem 0.8rem 3rem; } .eqs { padding-left: 0; }
  h1 { font-size: 1.5rem; } }
@page { size: A4; margin: 18mm 16mm; }
@media print {
  :root { --ink: #000000; --soft: #444444; --line: #bbbbbb; --paper: #ffffff; --tint: #ffffff;
    --link: #000000; color-scheme: light; }
  html { font-size: 9.5pt; }
  body { line-height: 1.4; }
  h2 { margin-top: 1.6rem; }
  th, td { padding: 0.08rem 0.7rem 0.08rem 0; }
  table { line-height: 1.3; }
  figure svg { max-height: 130mm; width: auto; }
  .sums { columns: 2; }
  .listing .eqs math { font-size: 0.9em; }
  .eqs p { margin: 0.15rem 0; }
  main { max-width: none; padding: 0; }
  nav { border: 1px solid var(--line); }
  h2, h3 { break-after: avoid; }
  figure, tr { break-inside: avoid; }
  thead { display: table-header-group; }
  .eqs, .wide { overflow: visible; }
  .eqs p { line-height: 1.45; }
  .listing .eqs { columns: 3; }
  .many { columns: 2; }
  table.matrix td { min-width: 0; padding: 0.1rem 0.15rem; }
}
"""
