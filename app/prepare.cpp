// prepare: asks whether the folder can be written, reads, works, writes, and tells what a scene needs.
#include "commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/text.h"
#include "interrupt.h"
#include "places.h"
#include "prepare/fill.h"
#include "prepare/sky.h"
#include "prepare/star_removal.h"
#include "prepare_settings.h"
#include "source/fits.h"
#include "source/picture.h"
#include "source/prepared_picture.h"
#include "source/write_image.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

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
std::vector<fs::path> pictures_of(const PrepareOptions& options, const PrepareParams& params) {
    std::vector<fs::path> files{options.folder / "picture.exr"};
    if (params.stars == PrepareParams::Stars::remove) files.push_back(options.folder / "stars.csv");
    if (params.background != PrepareParams::Background::keep)
        files.push_back(options.folder / "background.json");
    if (options.split) files.insert(files.end(), {options.folder / "front.exr", options.folder / "back.exr"});
    return files;
}

// The part that the mask shows, and the picture with that part filled from around it.
void write_split(const PrepareOptions& options, const Image& picture, const std::string& credit,
                 const Progress& progress) {
    const Image mask = read_mask_like(picture, "--split", *options.split);
    const Existing existing = existing_of(options.overwrite);
    Image front = picture;
    cut_with_mask(front, mask);
    write_linear_image(options.folder / "front.exr", front, credit, existing);
    Image back = picture;
    fill(back, bright_pixels(mask), FillKind::texture, progress);
    write_linear_image(options.folder / "back.exr", back, credit, existing);
}

void write_all(const PrepareOptions& options, const PrepareParams& params, const PreparedPicture& result,
               const Image& picture, const Progress& progress) {
    const Existing existing = existing_of(options.overwrite);
    if (options.split) write_split(options, result.image, result.credit, progress);
    write_linear_image(options.folder / "picture.exr", picture, result.credit, existing);
    if (params.stars == PrepareParams::Stars::remove)
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

std::string star_summary(const PrepareParams& params, const std::vector<PictureStar>& stars) {
    if (params.stars == PrepareParams::Stars::keep) return "left in the picture";
    const auto saturated = std::ranges::count_if(stars, &PictureStar::saturated);
    return fmt::format("{} taken away, {} of them saturated", stars.size(), saturated);
}

void print_summary(const PrepareOptions& options, const PrepareParams& params, const PreparedPicture& result,
                   const Image& picture) {
    std::string names;
    for (const fs::path& file : pictures_of(options, params))
        names += " " + printable(file.filename().string());
    fmt::print("picture     {}x{} px, linear light, {}\n", picture.width, picture.height,
               picture.channels == 4 ? "alpha" : "no alpha");
    fmt::print("stars       {}\n", star_summary(params, result.stars));
    fmt::print("background  {}\n", sky_summary(result.sky));
    fmt::print("written     {}:{}\n", printable(options.folder.string()), names);
    fmt::print("next        astrosplat new {} -o SCENE.toml\n",
               printable((options.folder / "picture.exr").string()));
}

// Of all input files, before any of the work.
void require_inputs(const PrepareOptions& options, const PrepareParams& params) {
    for (const fs::path& file : {options.image, options.red, options.green, options.blue, params.align,
                                 params.fill, params.mask, options.split.value_or(fs::path())})
        if (!file.empty()) require_picture(file);
    if (options.settings.contains("stretch") && !options.image.empty() && !is_fits(options.image))
        bad_input("--stretch", "", "a FITS picture", "'" + options.image.string() + "'");
}

}  // namespace

int run_prepare(const PrepareOptions& options) {
    const TextureSettings settings = prepare_settings(options);
    const PrepareParams& params = settings.prepare;
    require_inputs(options, params);
    for (const fs::path& file : pictures_of(options, params)) refuse_to_overwrite(file, options.overwrite);
    prove_writable(options.folder);
    ProgressReport report(options.progress);
    Progress progress = report.begin_step("preparing");
    progress.cancelled = &interrupted();
    std::vector<fs::path> inputs{options.image};
    if (has_three_filters(options)) inputs = {options.red, options.green, options.blue};
    const PreparedPicture result = prepare_picture(inputs, settings, progress);
    const Image picture = without_plain_alpha(result.image);
    write_all(options, params, result, picture, progress);
    print_summary(options, params, result, picture);
    return exit_done;
}

}  // namespace astrosplat
