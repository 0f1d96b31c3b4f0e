// prepare: asks whether the folder can be written, reads, works, writes, and tells what a scene needs.
#include "prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/text.h"
#include "interrupt.h"
#include "output/write_picture.h"
#include "places.h"
#include "prepare/star_removal.h"
#include "prepare/star_table.h"
#include "prepare_input.h"
#include "source/picture.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

double number_above_zero(const char* option, const std::string& text) {
    const std::optional<double> value = parse_double(text);
    if (!value || !(*value > 0.0) || !std::isfinite(*value))
        bad_input(option, "", "a number above 0", "'" + text + "'");
    return *value;
}

TextureSettings settings_of(const PrepareOptions& options) {
    using Stretch = TextureSettings::Stretch;
    TextureSettings settings;
    if (!options.stretch) return settings;
    const std::vector<std::string> names = all_names<Stretch>();
    const auto found = std::find(names.begin(), names.end(), *options.stretch);
    if (found == names.end()) bad_input("--stretch", "", alternatives(names), "'" + *options.stretch + "'");
    settings.stretch = static_cast<Stretch>(found - names.begin());
    return settings;
}

StarSettings star_settings_of(const PrepareOptions& options, double saturation) {
    StarSettings stars;
    stars.saturation = saturation;
    if (options.threshold) stars.threshold = number_above_zero("--threshold", *options.threshold);
    if (options.saturation) stars.saturation = number_above_zero("--saturation", *options.saturation);
    return stars;
}

// Alpha where the picture has some: without it, a scene takes it from the brightness.
Image without_plain_alpha(Image image, const PixelMask& empty) {
    bool plain = true;
    for (std::size_t i = 0; i < empty.pixels.size(); ++i) {
        float* const p = image.pixels.data() + 4 * i;
        if (empty.pixels[i]) std::fill_n(p, 4, 0.0f);
        plain = plain && p[3] == 1.0f;
    }
    if (!plain) return image;
    Image colors = make_image(image.width, image.height, 3);
    for (std::int64_t i = 0; i < image.width * image.height; ++i)
        std::copy_n(image.pixels.data() + 4 * i, 3, colors.pixels.data() + 3 * i);
    return colors;
}

void print_summary(const PrepareOptions& options, const Image& image, const std::vector<PictureStar>& stars) {
    const auto saturated =
        std::count_if(stars.begin(), stars.end(), [](const PictureStar& star) { return star.saturated; });
    const fs::path picture = options.folder / "picture.exr";
    fmt::print("picture   {}x{} px, linear light, {}\n", image.width, image.height,
               image.channels == 4 ? "alpha" : "no alpha");
    fmt::print("stars     {}\n", options.keep_stars ? "left in the picture"
                                                    : fmt::format("{} taken away, {} of them saturated",
                                                                  stars.size(), saturated));
    fmt::print("next      astrosplat new {} -o SCENE.toml\n", printable(picture.string()));
    fmt::print("{}\n", printable(picture.string()));
    if (!options.keep_stars) fmt::print("{}\n", printable((options.folder / "stars.csv").string()));
}

}  // namespace

int run_prepare(const PrepareOptions& options) {
    const TextureSettings settings = settings_of(options);
    star_settings_of(options, 1.0);  // its messages come before any work
    require_picture(options.image);
    for (const char* name : {"picture.exr", "stars.csv"})
        refuse_to_overwrite(options.folder / name, options.overwrite);
    prove_writable(options.folder);
    ProgressReport report(options.progress);
    Progress progress = report.begin_step("preparing");
    progress.cancelled = &interrupted();
    PrepareInput input = read_prepare_input(options.image, settings, progress);
    StarRemoval result;
    if (options.keep_stars) {
        result.starless = std::move(input.image);
    } else {
        claim_memory(star_removal_bytes(input.image), "star removal");
        result = remove_stars(input.image, star_settings_of(options, input.saturation), progress);
    }
    apply_stretch(result.starless, input.stretch, settings.softening);
    const Image picture = without_plain_alpha(std::move(result.starless), input.empty);
    const Existing existing = existing_of(options.overwrite);
    write_linear_picture(options.folder / "picture.exr", picture, input.credit, existing);
    if (!options.keep_stars)
        write_file_atomically(options.folder / "stars.csv",
                              star_table(result.stars, picture.width, picture.height), existing);
    print_summary(options, picture, result.stars);
    return exit_done;
}

}  // namespace astrosplat
