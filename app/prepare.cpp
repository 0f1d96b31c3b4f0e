// prepare: asks whether the folder can be written, reads, works, writes, and tells what a scene needs.
#include "prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/text.h"
#include "interrupt.h"
#include "output/write_picture.h"
#include "places.h"
#include "prepare/sky.h"
#include "prepare/star_removal.h"
#include "prepare/star_table.h"
#include "prepare_input.h"
#include "prepare_settings.h"
#include "source/picture.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

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

// The pixels of a mask picture of the same size that are brighter than black; with it the picture itself.
Image read_mask(const char* option, const fs::path& file, const Image& like) {
    Image mask = load_raw_image(file);
    if (mask.width != like.width || mask.height != like.height)
        bad_input(option, file.string(), fmt::format("{}x{} px like the picture", like.width, like.height),
                  fmt::format("{}x{} px", mask.width, mask.height));
    return mask;
}

PixelMask bright_pixels(const Image& mask) {
    PixelMask bright = make_mask(mask.width, mask.height);
    for (std::size_t i = 0; i < bright.pixels.size(); ++i) bright.pixels[i] = mask.pixels[3 * i] > 0.0f;
    return bright;
}

// What `prepare` makes of a picture, stage by stage.
struct Prepared {
    Image image;
    std::vector<PictureStar> stars;
    std::optional<SkySurface> sky;
};

PrepareInput read_input(const PrepareOptions& options, const PrepareSettings& settings,
                        const Progress& progress) {
    PrepareInput input =
        settings.three_filters
            ? read_three_filters({options.red, options.green, options.blue}, settings.texture, progress)
            : read_prepare_input(options.image, settings.texture, progress);
    if (std::isfinite(settings.stars.saturation)) input.saturation = settings.stars.saturation;
    return input;
}

Prepared prepared(const PrepareOptions& options, const PrepareSettings& settings, PrepareInput& input,
                  const Progress& progress) {
    Prepared result;
    if (options.holes)
        fill(input.image, bright_pixels(read_mask("--fill", *options.holes, input.image)), FillKind::texture,
             progress);
    if (options.keep_stars) {
        result.image = std::move(input.image);
    } else {
        claim_memory(star_removal_bytes(input.image), "star removal");
        StarRemoval removal =
            remove_stars(input.image, {settings.stars.threshold, input.saturation}, progress);
        result.image = std::move(removal.starless);
        result.stars = std::move(removal.stars);
    }
    if (settings.sky_degree) {
        result.sky = fit_sky(result.image, *settings.sky_degree);
        subtract_sky(result.image, *result.sky);
    }
    if (settings.three_filters)
        apply_lupton(result.image, settings.lupton);
    else
        apply_stretch(result.image, input.stretch, settings.texture.softening);
    if (settings.ellipse) cut_ellipse(result.image, *settings.ellipse);
    if (options.mask) cut_with_mask(result.image, read_mask("--mask", *options.mask, result.image));
    if (settings.alpha) alpha_from_luminance(result.image, settings.alpha->first, settings.alpha->second);
    return result;
}

std::string sky_text(const SkySurface& sky) {
    const nlohmann::ordered_json json = {{"terms", {"1", "u", "v", "u^2", "u*v", "v^2"}},
                                         {"u", "-1 left, 1 right"},
                                         {"v", "-1 top, 1 bottom"},
                                         {"unit", "linear light before the stretch"},
                                         {"red", sky.coefficients[0]},
                                         {"green", sky.coefficients[1]},
                                         {"blue", sky.coefficients[2]}};
    return json.dump(2) + "\n";
}

// Names of the files that these options ask for.
std::vector<fs::path> files_of(const PrepareOptions& options) {
    std::vector<fs::path> files{options.folder / "picture.exr"};
    if (!options.keep_stars) files.push_back(options.folder / "stars.csv");
    if (options.background) files.push_back(options.folder / "background.json");
    if (options.split) files.insert(files.end(), {options.folder / "front.exr", options.folder / "back.exr"});
    return files;
}

// What the mask shows, and the picture with that part filled from around it.
void write_split(const PrepareOptions& options, const Image& picture, const std::string& credit,
                 const Progress& progress) {
    const Image mask = read_mask("--split", *options.split, picture);
    const Existing existing = existing_of(options.overwrite);
    Image front = picture;
    cut_with_mask(front, mask);
    write_linear_picture(options.folder / "front.exr", front, credit, existing);
    Image back = picture;
    fill(back, bright_pixels(mask), FillKind::texture, progress);
    write_linear_picture(options.folder / "back.exr", back, credit, existing);
}

void write_all(const PrepareOptions& options, const PrepareInput& input, const Prepared& result,
               const Image& picture, const Progress& progress) {
    const Existing existing = existing_of(options.overwrite);
    if (options.split) write_split(options, result.image, input.credit, progress);
    write_linear_picture(options.folder / "picture.exr", picture, input.credit, existing);
    if (!options.keep_stars)
        write_file_atomically(options.folder / "stars.csv",
                              star_table(result.stars, picture.width, picture.height), existing);
    if (result.sky)
        write_file_atomically(options.folder / "background.json", sky_text(*result.sky), existing);
}

std::string sky_summary(const std::optional<SkySurface>& sky) {
    if (!sky) return "left in the picture";
    return fmt::format("{:.4g} {:.4g} {:.4g} in the middle taken off", sky->at(0.0, 0.0, 0),
                       sky->at(0.0, 0.0, 1), sky->at(0.0, 0.0, 2));
}

void print_summary(const PrepareOptions& options, const Prepared& result, const Image& picture) {
    const auto saturated = std::count_if(result.stars.begin(), result.stars.end(),
                                         [](const PictureStar& star) { return star.saturated; });
    std::string names;
    for (const fs::path& file : files_of(options)) names += " " + printable(file.filename().string());
    fmt::print("picture     {}x{} px, linear light, {}\n", picture.width, picture.height,
               picture.channels == 4 ? "alpha" : "no alpha");
    fmt::print("stars       {}\n", options.keep_stars ? "left in the picture"
                                                      : fmt::format("{} taken away, {} of them saturated",
                                                                    result.stars.size(), saturated));
    fmt::print("background  {}\n", sky_summary(result.sky));
    fmt::print("written     {}:{}\n", printable(options.folder.string()), names);
    fmt::print("next        astrosplat new {} -o SCENE.toml\n",
               printable((options.folder / "picture.exr").string()));
}

}  // namespace

int run_prepare(const PrepareOptions& options) {
    const PrepareSettings settings = prepare_settings(options);
    for (const fs::path& file : {options.image, options.red, options.green, options.blue})
        if (!file.empty()) require_picture(file);
    for (const fs::path& file : files_of(options)) refuse_to_overwrite(file, options.overwrite);
    prove_writable(options.folder);
    ProgressReport report(options.progress);
    Progress progress = report.begin_step("preparing");
    progress.cancelled = &interrupted();
    PrepareInput input = read_input(options, settings, progress);
    const Prepared result = prepared(options, settings, input, progress);
    const Image picture = without_plain_alpha(result.image, input.empty);
    write_all(options, input, result, picture, progress);
    print_summary(options, result, picture);
    return exit_done;
}

}  // namespace astrosplat
