#include "edit/picture_start.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "edit/layers.h"
#include "prepare/star_removal.h"
#include "scene/load.h"
#include "scene/new_scene.h"
#include "scene/save.h"
#include "source/picture.h"
#include "source/prepared_picture.h"
#include "stars/catalogue.h"

namespace astrosplat {
namespace {

fs::path table_of_stars(const fs::path& picture, const fs::path& place) {
    const fs::path table = place.parent_path() / (place.stem().string() + "_stars.csv");
    std::error_code ignored;
    if (fs::exists(table, ignored)) return table;
    write_star_table(picture, {}, table, Existing::keep);
    return table;
}

/// "seen at 62 degrees", "seen face-on", of the first of its galaxies or the axis; empty where neither is
/// inclined.
std::string seen_in_words(const PictureScene& scene) {
    if (scene.axis)
        return fmt::format("its axis leaning out by {:.0f} degrees", std::fabs(scene.axis->tilt_deg));
    const bool has_disk = !scene.galaxies.empty() && scene.object == SkyObject::galaxy;
    if (!has_disk || !scene.galaxies.front().inclination) return "";
    const double degrees = *scene.galaxies.front().inclination;
    return degrees < 1.0 ? "seen face-on" : fmt::format("seen at {:.0f} degrees", degrees);
}

}  // namespace

std::string picture_start_text(PictureStart& start, const fs::path& place, const SetCache& cache) {
    require_picture(start.picture);
    const fs::path table = start.parted ? table_of_stars(start.picture, place) : fs::path();
    Identification found;
    PictureScene scene = picture_scene(start.picture, {start.as, nullptr, {}, table}, found);
    scene.film = start.film;
    scene.parted = !scene.stars.empty() && start.parted;
    start.object = scene.object;
    if (!start.as) start.guesses = found.guesses;
    start.seen = seen_in_words(scene);
    start.because = joined_once({start.as ? "you say so" : found.why, scene.lies_by});
    std::string text = picture_scene_text(scene, place);
    if (start.most_splats > 0) {
        Scene limited = parse_scene(text, place);
        limited.layers.front().source.splats = start.most_splats;
        text = save_text(limited, text, place);
    }
    return start.film ? with_detail(text, place, cache).text : text;
}

void write_star_table(const fs::path& picture, const fs::path& starless, const fs::path& table,
                      Existing existing, const Progress& progress) {
    TextureSettings settings;
    settings.prepare.starless = starless;
    settings.prepare.stars = PrepareParams::Stars::remove;
    const PreparedPicture prepared = prepare_picture({picture}, settings, progress);
    write_file_atomically(table, star_table(prepared.stars, prepared.image.width, prepared.image.height),
                          existing);
}

FilmText with_detail(const std::string& text, const fs::path& place, const SetCache& cache,
                     const Progress& progress) {
    Scene film = parse_scene(text, place);
    FilmText made;
    made.detail = set_detail(film, double(usual_detail_splats), cache, progress);
    made.text = save_text(film, text, place);
    return made;
}

PictureStart chosen_start(PictureStart start, const std::string& choice) {
    if (choice == "film" || choice == "still") {
        start.film = choice == "film";
    } else if (choice == "part" || choice == "keep") {
        start.parted = choice == "part";
    } else if (choice == "whole") {
        start.most_splats = 0;
    } else if (choice.starts_with("splats ")) {
        start.most_splats = parse_int64(choice.substr(7)).value();
    } else {
        const std::vector<std::string> names = all_names<SkyObject>();
        const auto name = std::ranges::find(names, choice);
        if (name == names.end()) throw InputError("expected a kind of object, found '" + choice + "'");
        start.as = static_cast<SkyObject>(name - names.begin());
    }
    return start;
}

bool is_picture(const fs::path& file) {
    return kind_of_file(file) == FileKind::picture && !is_fits_catalogue(file);
}

}  // namespace astrosplat
