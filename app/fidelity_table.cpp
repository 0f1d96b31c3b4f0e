#include "fidelity_table.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace astrosplat {
namespace {

/// Targets for the front view of a good film of a galaxy or a nebula.
struct FrontTargets {
    double psnr_db, ssim;
};
constexpr FrontTargets small_targets{39.0, 0.98}, full_targets{36.0, 0.96};
constexpr double frame_off = 0.005, cells_off = 0.02, most_needles = 0.05;

Verdict verdict(bool met) { return met ? Verdict::met : Verdict::missed; }

bool within(double value, double lo, double hi) { return value >= lo && value <= hi; }

std::string power_text(const std::vector<ScalePower>& power) {
    std::string text;
    for (const ScalePower& band : power) text += fmt::format("{}{:.2f}", text.empty() ? "" : " ", band.ratio);
    return text;
}

void add_front(std::vector<FidelityRow>& rows, const FrontFidelity& front, const FrontTargets& targets) {
    const std::string view = fmt::format("front at {} x {} px", front.width_px, front.height_px);
    const auto add = [&](const char* measure, const std::string& value, const std::string& target, bool met) {
        rows.push_back({view, measure, value, target, target.empty() ? Verdict::none : verdict(met)});
    };
    const FluxRatios& flux = front.flux;
    add("PSNR", fmt::format("{:.2f} dB", front.psnr_db), fmt::format("at least {:g} dB", targets.psnr_db),
        front.psnr_db >= targets.psnr_db);
    add("SSIM", fmt::format("{:.4f}", front.ssim), fmt::format("at least {:g}", targets.ssim),
        front.ssim >= targets.ssim);
    add("light, whole frame", percent_off(flux.frame), "within 0.5 %",
        std::fabs(flux.frame - 1.0) <= frame_off);
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

// Targets of a disk say nothing of sheets and walls.
void add_edge(std::vector<FidelityRow>& rows, const EdgeOnProfile& edge, bool disk) {
    const auto add = [&](const char* what, double value, int decimals, const char* target, bool met) {
        rows.push_back({"edge-on", what, fmt::format("{:.{}f}", value, decimals), disk ? target : "",
                        disk && *target ? verdict(met) : Verdict::none});
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

}  // namespace

const char* word_of(Verdict verdict) {
    return verdict == Verdict::none ? "" : verdict == Verdict::met ? "met" : "missed";
}

std::string percent_off(double ratio) {
    return std::isnan(ratio) ? "no light" : fmt::format("{:+.2f} %", 100.0 * (ratio - 1.0));
}

std::vector<FidelityRow> fidelity_rows(const FidelityReport& report) {
    std::vector<FidelityRow> rows;
    add_front(rows, report.front, small_targets);
    if (report.full.width_px != report.front.width_px) add_front(rows, report.full, full_targets);
    const double needles = report.needles.share;
    rows.push_back({"from 60 degrees", "needles",
                    fmt::format("{:.3f} of {} points", needles, report.needles.points), "at most 0.05",
                    verdict(needles <= most_needles)});
    rows.push_back({"from 60 degrees", "needles, the picture flat",
                    fmt::format("{:.3f} of {} points", report.flat_needles.share, report.flat_needles.points),
                    "", Verdict::none});
    add_edge(rows, report.edge, report.disk);
    return rows;
}

Report fidelity_json(const FidelityReport& report, const std::string& scene) {
    Report json;
    json["scene"] = scene;
    json["layer"] = report.layer;
    json["reference"] =
        report.reference.empty() ? "the layer's picture" : report.reference.filename().string();
    json["front"] = front_json(report.front);
    json["full_size"] = front_json(report.full);
    json["side"] = {{"needles_share", number(report.needles.share)},
                    {"points", report.needles.points},
                    {"flat_picture_needles_share", number(report.flat_needles.share)}};
    json["edge"] = {{"fwhm_over_length", number(report.edge.fwhm_over_length)},
                    {"dust_dip", number(report.edge.dust_dip)},
                    {"center_over_half_radius", number(report.edge.center_over_half)},
                    {"body_srgb", number(report.edge.body_srgb)}};
    return json;
}

}  // namespace astrosplat
