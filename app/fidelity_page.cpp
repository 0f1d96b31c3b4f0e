#include "fidelity_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/text.h"
#include "fidelity_charts.h"
#include "fidelity_table.h"

namespace astrosplat {
namespace {

// Light and dark by the reader's choice; one column on a phone. Images stand on black in both.
constexpr const char* style = R"css(
:root { color-scheme: light dark; --page: #fbfaf8; --ink: #24211d; --quiet: #75706a; --line: #e3dfd8; --card: #fff;
        --more: #c9640a; --less: #1f6fb8; --met: #2c7a4b; --missed: #b3402e; }
@media (prefers-color-scheme: dark) {
  :root { --page: #131317; --ink: #e6e3de; --quiet: #98938c; --line: #2d2d34; --card: #1a1a20;
          --more: #f09a4a; --less: #62acf0; --met: #74c795; --missed: #ee8571; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 2.5rem clamp(1rem, 4vw, 3rem) 4rem; max-width: 82rem; background: var(--page);
       color: var(--ink); font: 16px/1.55 system-ui, -apple-system, "Segoe UI", "Noto Sans", sans-serif; }
h1 { font-size: 1.7rem; font-weight: 600; letter-spacing: -.01em; margin: 0; }
h2 { font-size: 1.1rem; font-weight: 600; margin: 3rem 0 .3rem; }
p { margin: .3rem 0 1rem; max-width: 46rem; color: var(--quiet); }
p b, .sum { color: var(--ink); }
.columns { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); gap: 1.25rem; }
figure { margin: 0; min-width: 0; }
figcaption { font-size: .85rem; color: var(--quiet); padding: .4rem 0 0; }
img { display: block; width: 100%; height: auto; background: #000; border-radius: 6px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; max-width: 46rem; font-variant-numeric: tabular-nums; }
th { text-align: left; font-weight: 600; padding: 1.2rem 0 .35rem; }
td { padding: .32rem 1rem .32rem 0; border-top: 1px solid var(--line); vertical-align: top; }
td:nth-child(3), td:nth-child(4) { color: var(--quiet); font-size: .9rem; white-space: nowrap; }
td.met { color: var(--met) !important; } td.missed { color: var(--missed) !important; }
@media (max-width: 34rem) { table { font-size: .9rem; } td { padding-right: .6rem; } }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 1rem; }
svg { display: block; width: 100%; height: auto; }
svg text { font: 12px system-ui, sans-serif; fill: var(--quiet); }
.cells { background: var(--page); } .more { fill: var(--more); } .less { fill: var(--less); }
.dark { fill: var(--line); }
.grid { stroke: var(--line); } .one { stroke: var(--quiet); stroke-dasharray: 4 4; }
polyline { fill: none; stroke-width: 2; stroke-linejoin: round; }
.line0 polyline { stroke: var(--ink); } .line0 circle { fill: var(--ink); }
.line1 polyline { stroke: var(--less); } .line1 circle { fill: var(--less); }
.mark0 { color: var(--ink); } .mark1 { color: var(--less); }
.wipe { position: relative; display: none; touch-action: pan-y; cursor: ew-resize; }
.wipe img + img { position: absolute; top: 0; clip-path: inset(0 0 0 var(--at, 50%)); }
.wipe i { position: absolute; top: 0; bottom: 1.9rem; left: var(--at, 50%); width: 1px; background: #fff9; }
)css";

// The two images over each other, with a line to drag; without scripts they stay side by side.
constexpr const char* script = R"js(
const w = document.querySelector('.wipe'), m = w.querySelectorAll('img');
m[0].src = document.getElementById('seen').src; m[1].src = document.getElementById('reference').src;
w.style.display = 'block';
w.addEventListener('pointermove', e => { const r = w.getBoundingClientRect();
  w.style.setProperty('--at', Math.min(100, Math.max(0, 100 * (e.clientX - r.left) / r.width)) + '%'); });
)js";

std::string escaped(const std::string& text) {
    std::string html;
    for (const char c : printable(text)) {
        if (c == '&')
            html += "&amp;";
        else if (c == '<')
            html += "&lt;";
        else if (c == '>')
            html += "&gt;";
        else if (c == '"')
            html += "&quot;";
        else
            html += c;
    }
    return html;
}

std::string figure(const std::string& url, const std::string& caption, const std::string& id = "") {
    const std::string name = id.empty() ? "" : fmt::format(" id='{}'", id);
    return fmt::format("<figure><img{} alt='{}' src='{}'><figcaption>{}</figcaption></figure>\n", name,
                       caption, url, caption);
}

std::string table(const std::vector<FidelityRow>& rows) {
    std::string html = "<div class='scroll'><table>\n", view;
    for (const FidelityRow& row : rows) {
        if (row.view != view) html += fmt::format("<tr><th colspan='4'>{}</th></tr>\n", escaped(row.view));
        view = row.view;
        const std::string cells = row.target.empty()
                                      ? fmt::format("<td colspan='3'>{}</td>", row.value)
                                      : fmt::format("<td>{}</td><td>{}</td><td class='{}'>{}</td>", row.value,
                                                    row.target, word_of(row.verdict), word_of(row.verdict));
        html += fmt::format("<tr><td>{}</td>{}</tr>\n", row.measure, cells);
    }
    return html + "</table></div>\n";
}

std::string summary(const std::vector<FidelityRow>& rows) {
    const auto count = [&](Verdict verdict) {
        return std::count_if(rows.begin(), rows.end(),
                             [&](const FidelityRow& r) { return r.verdict == verdict; });
    };
    return fmt::format("{} of {} targets met", count(Verdict::met),
                       count(Verdict::met) + count(Verdict::missed));
}

std::string front_section(const FidelityReport& report) {
    std::string html =
        "<h2>Front</h2>\n<p>As rendered, and as the picture looks through the renderer's pixel filter.</p>\n";
    html += "<div class='columns'>\n" + figure(image_url(report.front_view), "rendered", "seen") +
            figure(image_url(report.front_reference), "picture", "reference") + "</div>\n";
    html +=
        "<figure class='wipe' style='margin-top:1.25rem'><img alt=''><img alt=''><i></i><figcaption>rendered "
        "to the left of the line, the "
        "picture to the right</figcaption></figure>\n";
    html +=
        "<h2>Difference</h2>\n<p>Orange where the render is brighter, blue where it is darker, in displayed "
        "values; "
        "full colour at a tenth of white.</p>\n";
    return html + figure(difference_url(report.front_view, report.front_reference), "rendered minus picture");
}

std::string charts_section(const FidelityReport& report) {
    std::vector<const FrontFidelity*> fronts{&report.front};
    if (report.full.width_px != report.front.width_px) fronts.push_back(&report.full);
    std::string marks;
    for (std::size_t i = 0; i < fronts.size(); ++i)
        marks += fmt::format("<span class='mark{}'>&#9679;</span> at {} px &nbsp; ", i, fronts[i]->width_px);
    const double aspect =
        static_cast<double>(report.front.width_px) / static_cast<double>(report.front.height_px);
    return "<h2>Light and detail</h2>\n<div class='columns'>\n<figure class='card'>" +
           cell_map(report.front.flux, aspect) +
           "<figcaption>Light of each of 32 x 32 cells: orange more, blue less than the picture, full at 10 "
           "%; grey "
           "cells hold none</figcaption></figure>\n<figure class='card'>" +
           power_chart(fronts) + "<figcaption>" + marks +
           "Power of the detail of each size over the picture's: below 1 too smooth, above too "
           "grainy</figcaption></figure>\n</div>\n";
}

std::string side_section(const FidelityReport& report) {
    return "<h2>From the side</h2>\n<div class='columns'>\n" +
           figure(image_url(report.side_view), "from 60 degrees") +
           figure(image_url(report.edge_view), "edge-on") + "</div>\n";
}

constexpr const char* definitions = R"html(<h2>How it is measured</h2>
<p>Orthographic views without the scene's sky, at its first frame. <b>PSNR</b> and <b>SSIM</b> compare displayed (sRGB)
values. <b>Light</b> is the sum of linear values over the picture's; cells are those of a 32 x 32 grid. <b>CIEDE2000</b> is
the difference of colour as eyes judge it; 1 is about the least that is seen. <b>Power</b> is that of differences of
Gaussian blurs an octave apart. <b>Needles</b> are those of the 400 strongest points from 60 degrees that are longer than
1.6 times their width. <b>Edge-on</b>, a galaxy's thickness is the full width at half maximum; NGC 891 measures 0.076 of
its length, with a dust lane 0.49 deep. Targets of the front are for galaxies and nebulae; for remnants of thin filaments
they are 36 dB and 0.97.</p>
)html";

}  // namespace

std::string fidelity_page(const FidelityReport& report, const std::string& scene) {
    const std::vector<FidelityRow> rows = fidelity_rows(report);
    const std::string title = "Fidelity of " + escaped(scene);
    const std::string reference =
        report.reference.empty() ? "its own picture" : escaped(report.reference.filename().string());
    return "<!doctype html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n"
           "<meta name='viewport' content='width=device-width, initial-scale=1'>\n<title>" +
           title + "</title>\n<style>" + style + "</style>\n</head>\n<body>\n<h1>" + title +
           "</h1>\n<p>Layer " + escaped(report.layer) + " against " + reference + ". <span class='sum'>" +
           summary(rows) + ".</span></p>\n" + table(rows) + front_section(report) + charts_section(report) +
           side_section(report) + definitions + "<script>" + script + "</script>\n</body>\n</html>\n";
}

}  // namespace astrosplat
