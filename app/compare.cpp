// compare: how far two images are apart, in linear premultiplied light.
#include "commands.h"

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/text.h"
#include "output/compare.h"
#include "report.h"

namespace astrosplat {
namespace {

double parse_limit(const std::string& text) {
    const std::optional<double> limit = parse_double(text);
    if (!limit || !(*limit >= 0.0)) bad_input("--max-difference", "", "a number >= 0", "'" + text + "'");
    return *limit;
}

}  // namespace

int run_compare(const CompareOptions& options) {
    const double limit = options.max_difference ? parse_limit(*options.max_difference)
                                                : std::numeric_limits<double>::infinity();
    const ImageComparison c = compare_files(options.a, options.b);
    Report report;
    report["identical"] = c.identical();
    report["max_difference"] = number(c.max_difference);
    report["max_at"] = {c.max_x, c.max_y};
    report["max_channel"] = std::string(1, "RGBA"[c.max_channel]);
    report["mean_difference"] = number(c.mean_difference);
    report["percentile_999"] = number(c.percentile_999);
    report["psnr_db"] = number(c.psnr_db);
    report["differing_pixels"] = c.differing_pixels;
    report["pixels"] = c.width * c.height;
    print_report(report, options.json);
    return c.max_difference > limit ? exit_some_failed : exit_done;
}

}  // namespace astrosplat
