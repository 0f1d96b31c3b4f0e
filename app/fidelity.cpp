// fidelity: loads a scene, asks whether the report can be written, measures, writes. The report is one page
// that asks for nothing from elsewhere: numbers against targets, images side by side, their difference,
// cells, power by scale and views from the side; or JSON.
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "batch_plan.h"
#include "command.h"
#include "core/error.h"
#include "core/image.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/text.h"
#include "estimate.h"
#include "exit.h"
#include "fidelity/display.h"
#include "fidelity/front.h"
#include "image/channels.h"
#include "measure_fidelity.h"
#include "output/format.h"
#include "scene/animate.h"
#include "scene/check.h"
#include "scene/frames.h"
#include "source/write_image.h"

namespace astrosplat {
namespace {

/// none: there is no target.
enum class Judgement { none, met, missed };

struct FidelityRow {
    std::string view;     // "front at 1280 px": what the rows of one view share
    std::string measure;  // "PSNR"
    std::string value;    // with its unit
    std::string target;   // "at least 39 dB"; empty: none
    Judgement verdict = Judgement::none;
};

constexpr FrontTargets full_targets{36.0, 0.96};
constexpr double cells_off = 0.02, most_needles = 0.05, most_mottle = 1.15;

Judgement verdict(bool met) { return met ? Judgement::met : Judgement::missed; }

bool within(double value, double lo, double hi) { return value >= lo && value <= hi; }

std::string power_text(const std::vector<ScalePower>& power) {
    std::string text;
    for (const ScalePower& band : power) text += fmt::format("{}{:.2f}", text.empty() ? "" : " ", band.ratio);
    return text;
}

/// A ratio as what is more or less: "+0.52 %".
std::string percent_off(double ratio) {
    return std::isnan(ratio) ? "no light" : fmt::format("{:+.2f} %", 100.0 * (ratio - 1.0));
}

void add_front(std::vector<FidelityRow>& rows, const FrontFidelity& front, const FrontTargets& targets) {
    const std::string view = fmt::format("front at {} x {} px", front.width_px, front.height_px);
    const auto add = [&](const char* measure, const std::string& value, const std::string& target, bool met) {
        rows.push_back({view, measure, value, target, target.empty() ? Judgement::none : verdict(met)});
    };
    const FluxRatios& flux = front.flux;
    add("PSNR", fmt::format("{:.2f} dB", front.psnr_db), fmt::format("at least {:g} dB", targets.psnr_db),
        front.psnr_db >= targets.psnr_db);
    add("SSIM", fmt::format("{:.4f}", front.ssim), fmt::format("at least {:g}", targets.ssim),
        front.ssim >= targets.ssim);
    add("light, whole frame", percent_off(flux.frame), "within 0.5 %",
        std::fabs(flux.frame - 1.0) <= most_light_off);
    add("light, red green blue",
        fmt::format("{}, {}, {}", percent_off(flux.channels[0]), percent_off(flux.channels[1]),
                    percent_off(flux.channels[2])),
        "", true);
    add("light, cells 5 to 95 %",
        fmt::format("{} to {}", percent_off(flux.cells_5), percent_off(flux.cells_95)), "within 2 %",
        flux.cells_5 >= 1.0 - cells_off && flux.cells_95 <= 1.0 + cells_off);
    add("CIEDE2000, median, 95 %",
        fmt::format("{:.2f}, {:.2f}", front.ciede2000.median, front.ciede2000.percentile_95), "", true);
    add("power, fine to coarse", power_text(front.power), "", true);
}

void add_above(std::vector<FidelityRow>& rows, const DiskFromAbove& above) {
    constexpr double least_round = 0.85, least_grain = 0.75, most_grain = 1.35;
    rows.push_back({"from above", "roundness", fmt::format("{:.2f}", above.roundness), "at least 0.85",
                    verdict(above.roundness >= least_round)});
    rows.push_back({"from above", "grain", fmt::format("{:.2f}", above.grain), "0.75 to 1.35",
                    verdict(within(above.grain, least_grain, most_grain))});
}

// Targets of a disk say nothing of sheets and walls.
void add_edge(std::vector<FidelityRow>& rows, const EdgeOnProfile& edge, bool disk) {
    const auto add = [&](const char* what, double value, int decimals, const char* target, bool met) {
        rows.push_back({"edge-on", what, fmt::format("{:.{}f}", value, decimals), disk ? target : "",
                        disk && *target ? verdict(met) : Judgement::none});
    };
    add("thickness over length", edge.fwhm_over_length, 3, "0.06 to 0.10",
        within(edge.fwhm_over_length, 0.06, 0.10));
    add("depth of the dust lane", edge.dust_dip, 2, "0.4 to 0.6", within(edge.dust_dip, 0.4, 0.6));
    add("centre over half radius", edge.center_over_half, 2, "at least 2.5", edge.center_over_half >= 2.5);
    add("body, displayed", edge.body_srgb, 2, "", true);
}

Report front_json(const FrontFidelity& front) {
    const char* const channels[] = {"red", "green", "blue"};
    Report json;
    json["width_px"] = front.width_px;
    json["height_px"] = front.height_px;
    json["psnr_db"] = number(front.psnr_db);
    json["ssim"] = number(front.ssim);
    json["ciede2000_median"] = number(front.ciede2000.median);
    json["ciede2000_percentile_95"] = number(front.ciede2000.percentile_95);
    Report& flux = json["flux_ratio"];
    flux["frame"] = number(front.flux.frame);
    for (std::size_t c = 0; c < 3; ++c) flux[channels[c]] = number(front.flux.channels[c]);
    flux["cells_percentile_5"] = number(front.flux.cells_5);
    flux["cells_median"] = number(front.flux.cells_50);
    flux["cells_percentile_95"] = number(front.flux.cells_95);
    flux["cells_per_side"] = flux_cells;
    for (const double ratio : front.flux.cells) flux["cells"].push_back(number(ratio));
    json["power_ratio"] = Report::array();
    for (const ScalePower& band : front.power)
        json["power_ratio"].push_back(
            {{"finer_px", band.finer_px}, {"coarser_px", band.coarser_px}, {"ratio", number(band.ratio)}});
    return json;
}

const char* word_of(Judgement verdict) {
    return verdict == Judgement::none ? "" : verdict == Judgement::met ? "met" : "missed";
}

std::vector<FidelityRow> fidelity_rows(const FidelityReport& report) {
    std::vector<FidelityRow> rows;
    add_front(rows, report.front, small_targets);
    if (report.full.width_px != report.front.width_px) add_front(rows, report.full, full_targets);
    rows.push_back({"from 45 degrees", "mottle", fmt::format("{:.2f}", report.mottle), "at most 1.15",
                    verdict(report.mottle <= most_mottle)});
    if (report.disk) add_above(rows, report.above);
    const double needles = report.needles.share;
    rows.push_back({"from 60 degrees", "needles",
                    fmt::format("{:.3f} of {} points", needles, report.needles.points), "at most 0.05",
                    verdict(needles <= most_needles)});
    rows.push_back({"from 60 degrees", "needles, the picture flat",
                    fmt::format("{:.3f} of {} points", report.flat_needles.share, report.flat_needles.points),
                    "", Judgement::none});
    add_edge(rows, report.edge, report.disk);
    return rows;
}

/// All numbers in full precision, under names that say their units.
Report fidelity_json(const FidelityReport& report, const std::string& scene) {
    Report json;
    json["scene"] = scene;
    json["layer"] = report.layer;
    json["reference"] =
        report.reference.empty() ? "the layer's picture" : report.reference.filename().string();
    json["credit"] = report.credit;
    json["front"] = front_json(report.front);
    json["full_size"] = front_json(report.full);
    json["tilted"] = {{"mottle", number(report.mottle)}};
    if (report.disk)
        json["above"] = {{"roundness", number(report.above.roundness)},
                         {"grain", number(report.above.grain)}};
    json["side"] = {{"needles_share", number(report.needles.share)},
                    {"points", report.needles.points},
                    {"flat_picture_needles_share", number(report.flat_needles.share)}};
    json["edge"] = {{"fwhm_over_length", number(report.edge.fwhm_over_length)},
                    {"dust_dip", number(report.edge.dust_dip)},
                    {"center_over_half_radius", number(report.edge.center_over_half)},
                    {"body_srgb", number(report.edge.body_srgb)}};
    return json;
}

// The report's drawings, as HTML: images and small vector graphics. The page chooses the
// colours of lines and letters.

constexpr double full_colour = 0.1;  // share of light that is shown in full colour

std::string png_url(const Image& size, std::span<const unsigned char> rgb) {
    return "data:image/png;base64," + base64(png_bytes(size.width, size.height, rgb));
}

/// -1 .. 1: how far light that is amiss is from none to full colour.
double strength(double amiss) { return std::clamp(amiss / full_colour, -1.0, 1.0); }

constexpr double chart_width = 440, chart_height = 250, chart_left = 44, chart_top = 14, chart_bottom = 40;

double chart_x(std::size_t band, std::size_t bands) {
    return chart_left +
           (static_cast<double>(band) + 0.5) * (chart_width - chart_left - 12) / static_cast<double>(bands);
}

double chart_y(double ratio, double top) {
    return chart_top + (1.0 - std::clamp(ratio, 0.0, top) / top) * (chart_height - chart_top - chart_bottom);
}

std::string power_line(const FrontFidelity& front, std::size_t bands, double top, std::size_t number) {
    std::string points, dots;
    for (std::size_t i = 0; i < front.power.size(); ++i) {
        const ScalePower& band = front.power[i];
        if (std::isnan(band.ratio)) continue;
        const double x = chart_x(i, bands), y = chart_y(band.ratio, top);
        points += fmt::format("{:.1f},{:.1f} ", x, y);
        dots += fmt::format(
            "<circle cx='{:.1f}' cy='{:.1f}' r='3.5'><title>{:g} to {:g} px: {:.3f}</title></circle>\n", x, y,
            band.finer_px, band.coarser_px, band.ratio);
    }
    return fmt::format("<g class='line{}'><polyline points='{}'/>\n{}</g>\n", number, points, dots);
}

/// "data:image/png;base64,...": the image as displayed.
std::string image_url(const Image& linear) {
    const FrameFormat format{FrameKind::png,
                             OutputParams::Depth::uint8,
                             OutputParams::Compression::deflate,
                             OutputParams::Alpha::none,
                             OutputParams::View::srgb,
                             OutputParams::Primaries::rec709,
                             0.0,
                             {}};
    return png_url(linear, encode_8bit(format, opaque(linear), 0, 0));
}

/// The same of displayed value a minus b, mean of the channels: orange where a is brighter, blue where it
/// is darker, full at a tenth of white.
std::string difference_url(const Image& a, const Image& b) {
    const Image shown = signed_difference(a, b);
    std::vector<unsigned char> rgb;
    rgb.reserve(static_cast<std::size_t>(a.width * a.height * 3));
    for (std::size_t i = 0; i < shown.pixels.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c)
            rgb.push_back(static_cast<unsigned char>(shown.pixels[i + c] * 255.0f + 0.5f));
    return png_url(a, rgb);
}

/// The grid of cells, each orange or blue by how much more or less light it has, full at a tenth; hatched
/// where the reference is dark. `aspect`: the picture's width over its height.
std::string cell_map(const FluxRatios& flux, double aspect) {
    const double width = 10.0, height = width / aspect;
    std::string svg = fmt::format(
        "<svg class='cells' viewBox='0 0 {:g} {:g}' role='img' aria-label='light of each cell'>\n",
        width * flux_cells, height * flux_cells);
    for (std::int64_t i = 0; i < flux_cells * flux_cells; ++i) {
        const double ratio = flux.cells[static_cast<std::size_t>(i)], t = strength(ratio - 1.0);
        const std::string place = fmt::format("x='{:g}' y='{:g}' width='{:g}' height='{:g}'",
                                              width * static_cast<double>(i % flux_cells),
                                              height * static_cast<double>(i / flux_cells), width, height);
        if (std::isnan(ratio))
            svg += fmt::format("<rect class='dark' {}/>\n", place);
        else
            svg += fmt::format("<rect class='{}' opacity='{:.2f}' {}><title>{}</title></rect>\n",
                               t > 0.0 ? "more" : "less", std::fabs(t), place, percent_off(ratio));
    }
    return svg + "</svg>\n";
}

/// Power ratio over scale, one line for each front view.
std::string power_chart(const std::vector<const FrontFidelity*>& fronts) {
    std::size_t bands = 1;
    double top = 1.25;
    for (const FrontFidelity* front : fronts) {
        bands = std::max(bands, front->power.size());
        for (const ScalePower& band : front->power) top = std::max(top, std::min(2.0, 1.05 * band.ratio));
    }
    std::string svg =
        fmt::format("<svg class='power' viewBox='0 0 {:g} {:g}' role='img' aria-label='power by scale'>\n",
                    chart_width, chart_height);
    for (double ratio = 0.0; ratio <= top; ratio += 0.25) {
        const double y = chart_y(ratio, top);
        svg += fmt::format("<line class='{}' x1='{:g}' x2='{:g}' y1='{:.1f}' y2='{:.1f}'/>\n",
                           ratio == 1.0 ? "one" : "grid", chart_left, chart_width - 12, y, y);
        svg += fmt::format("<text x='{:g}' y='{:.1f}' text-anchor='end'>{:g}</text>\n", chart_left - 8, y + 4,
                           ratio);
    }
    for (std::size_t i = 0; i < bands; ++i)
        svg += fmt::format("<text x='{:.1f}' y='{:g}' text-anchor='middle'>{:g}</text>\n", chart_x(i, bands),
                           chart_height - chart_bottom + 18,
                           i == 0 ? 0.5 : std::ldexp(0.75, static_cast<int>(i)));
    svg += fmt::format("<text x='{:g}' y='{:g}' text-anchor='middle'>size of the detail, px</text>\n",
                       0.5 * (chart_left + chart_width), chart_height - 4);
    for (std::size_t i = 0; i < fronts.size(); ++i) svg += power_line(*fronts[i], bands, top, i);
    return svg + "</svg>\n";
}

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
    static const std::map<char, std::string> entities{
        {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
    std::string html;
    for (const char c : printable(text)) html += entities.contains(c) ? entities.at(c) : std::string(1, c);
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
    const auto count = [&](Judgement verdict) {
        return std::count_if(rows.begin(), rows.end(),
                             [&](const FidelityRow& r) { return r.verdict == verdict; });
    };
    return fmt::format("{} of {} targets met", count(Judgement::met),
                       count(Judgement::met) + count(Judgement::missed));
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

/// HTML. `scene`: the name in the heading.
std::string fidelity_page(const FidelityReport& report, const std::string& scene) {
    const std::vector<FidelityRow> rows = fidelity_rows(report);
    const std::string title = "Fidelity of " + escaped(scene);
    const std::string reference =
        report.reference.empty() ? "its own picture" : escaped(report.reference.filename().string());
    const std::string credit =
        report.credit.empty() ? "" : "<h2>Credit</h2>\n<p>" + escaped(report.credit) + "</p>\n";
    return "<!doctype html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n"
           "<meta name='viewport' content='width=device-width, initial-scale=1'>\n<title>" +
           title + "</title>\n<style>" + style + "</style>\n</head>\n<body>\n<h1>" + title +
           "</h1>\n<p>Layer " + escaped(report.layer) + " against " + reference + ". <span class='sum'>" +
           summary(rows) + ".</span></p>\n" + table(rows) + front_section(report) + charts_section(report) +
           side_section(report) + definitions + credit + "<script>" + script +
           "</script>\n</body>\n</html>\n";
}

struct FidelityOptions {
    std::optional<fs::path> reference;  // in place of the layer's own picture
};

bool ends_in_html(const fs::path& file) {
    const std::string ending = lower_case(file.extension().string());
    if (ending == ".html" || ending == ".htm") return true;
    if (ending != ".json")
        bad_input(file.string(), "", "a name ending in .html or .json",
                  "'" + file.extension().string() + "'");
    return false;
}

/// The scene with the command line applied, as it stands at its first frame.
Scene scene_to_measure(const CommandOptions& options) {
    const auto [scene, places] = load_placed(options.input, assignments_of(options));
    Scene judged = scene;  // its cameras and its sky are not rendered
    judged.camera = {};
    judged.environment = {};
    std::erase_if(judged.animation, [](const Track& track) { return track.key.layer().empty(); });
    check_renderable(judged, places);
    const std::int64_t first =
        parse_frames(scene.output.frames, scene.file.string() + ": output.frames").front();
    Scene now = scene_at(judged, static_cast<double>(first));
    now.camera = {};
    stop_animation(now);
    return now;
}

void announce_memory(const Scene& now, const FidelityReference& reference, const FidelitySettings& settings) {
    BatchPlan plan;
    plan.scene = now;
    plan.cache = settings.cache;
    plan.scene.output.width = std::max(settings.width_px, reference.picture.width);
    plan.scene.output.height = reference.height_px(plan.scene.output.width);
    plan.scene.output.aovs.clear();
    const JobEstimate job = estimate(plan);
    const std::int64_t bytes = job.bytes + fidelity_bytes(reference, settings);
    log_info(fmt::format("front views of {} and {} px, about {}, about {} of memory", settings.width_px,
                         reference.picture.width, human_count(job.splats, "splat"),
                         human_bytes(static_cast<double>(bytes))));
}

/// A front view holds the light of all layers, a picture that of one.
void warn_of_other_layers(const Scene& now, const FidelityReference& reference) {
    const auto shown = std::count_if(now.layers.begin(), now.layers.end(),
                                     [](const LayerParams& layer) { return layer.visible; });
    if (shown > 1 && reference.file.empty())
        log_warning(
            fmt::format("{} layers are seen, and compared with the picture of '{}' alone; --reference names "
                        "another picture",
                        shown, reference.layer));
}

void print_rows(const std::vector<FidelityRow>& rows) {
    std::string view;
    for (const FidelityRow& row : rows) {
        if (row.view != view) fmt::print("{}\n", row.view);
        view = row.view;
        const std::string line = fmt::format("  {:<24} {:>28}   {:<18} {}", row.measure, row.value,
                                             row.target, word_of(row.verdict));
        fmt::print("{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
    }
}

int run_fidelity(const CommandOptions& options, const FidelityOptions& own) {
    const bool html = ends_in_html(*options.output);
    const Scene now = scene_to_measure(options);
    const WriteTarget target = claim_output(options);
    ProgressReport progress(options.progress);
    const FidelityReference reference =
        fidelity_reference(now, own.reference, progress.begin_step("reading the picture"), options.cache);
    warn_of_other_layers(now, reference);
    FidelitySettings settings;
    settings.cache = options.cache;
    settings.begin_step = [&](const std::string& step) { return progress.begin_step(step); };
    announce_memory(now, reference, settings);
    const FidelityReport report = measure_fidelity(now, reference, settings);
    const std::string name = now.file.filename().string();
    const std::string text =
        html ? fidelity_page(report, name)
             : fidelity_json(report, name).dump(2, ' ', false, Report::error_handler_t::replace) + "\n";
    write_file_atomically(target.file, text, target.existing);
    print_rows(fidelity_rows(report));
    fmt::print("{}\n", printable(target.file.string()));
    return exit_done;
}

}  // namespace

void add_fidelity(CLI::App& app, Invocation& call) {
    auto [command, own] =
        add_command(app, call, "fidelity", "Measures how true a scene is to its picture", run_fidelity);
    add_input(command, call.options, "SCENE", "The scene");
    add_output(command, call.options, "REPORT.(html|json)", "The report to write");
    add_value(command, "--reference", own.reference, "IMAGE",
              "A picture to compare with, in place of the layer's own");
    add_assignments(command, call.options);
    add_progress(command, call.options);
}

}  // namespace astrosplat
