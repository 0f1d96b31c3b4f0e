#include "edit/picture_start.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/real.h"
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

fs::path table_of_stars(const fs::path& picture, const fs::path& place, const Progress& progress) {
    const fs::path table = place.parent_path() / (place.stem().string() + "_stars.csv");
    std::error_code ignored;
    if (fs::exists(table, ignored)) return table;
    write_star_table(picture, {}, table, Existing::keep, progress);
    return table;
}

constexpr ObjectWords object_words[] = {{"a galaxy", "Galaxy"},
                                        {"an elliptical galaxy", "Elliptical galaxy"},
                                        {"a nebula", "Nebula"},
                                        {"a planetary nebula", "Planetary nebula"},
                                        {"a supernova remnant", "Supernova remnant"},
                                        {"a field of stars or galaxies", "Stars or galaxies"},
                                        {"a globular cluster", "Globular cluster"},
                                        {"something flat", "Flat, as a comet"}};
static_assert(std::size(object_words) == sky_object_count);

}  // namespace

const ObjectWords& kind_words(SkyObject object) { return object_words[static_cast<std::size_t>(object)]; }

std::string seen_in_words(const Scene& scene, SkyObject object) {
    if (scene.layers.empty()) return "";
    const StructureParams& structure = scene.layers.front().source.structure;
    if (structure.kind == StructureKind::axis && structure.tilt)
        return fmt::format("its axis leaning out by {:.0f} degrees", std::fabs(*structure.tilt));
    const GalaxyParams& galaxy = structure.galaxies.empty() ? structure.galaxy : structure.galaxies.front();
    if (object != SkyObject::galaxy || structure.kind != StructureKind::disk || !galaxy.inclination)
        return "";
    const double degrees = *galaxy.inclination;
    return degrees < 1.0 ? "seen face-on" : fmt::format("seen at {:.0f} degrees", degrees);
}

bool only_lies_otherwise(const Document& document) {
    if (!document.edited()) return true;
    Scene scene = document.scene();
    const std::vector<LayerParams>& began = document.saved_scene().layers;
    for (std::size_t i = 0; i < std::min(began.size(), scene.layers.size()); ++i) {
        StructureParams& structure = scene.layers[i].source.structure;
        const StructureParams& before = began[i].source.structure;
        structure.galaxy = before.galaxy;
        structure.galaxies = before.galaxies;
        structure.axis_angle = before.axis_angle;
        structure.tilt = before.tilt;
    }
    return scene == document.saved_scene();
}

std::string picture_start_text(PictureStart& start, const fs::path& place, const SetCache& cache,
                               const Progress& progress) {
    require_picture(start.picture);
    const fs::path table =
        start.parted ? table_of_stars(start.picture, place, progress.silent()) : fs::path();
    Identification found;
    PictureScene scene = picture_scene(start.picture, {start.as, nullptr, {}, table}, found, progress);
    scene.film = start.film;
    scene.parted = !scene.stars.empty() && start.parted;
    start.object = scene.object;
    if (!start.as) start.guesses = found.guesses;
    start.because = joined_once({start.as ? "you say so" : found.why, scene.lies_by});
    std::string text = picture_scene_text(scene, place);
    const Scene made = parse_scene(text, place);
    start.seen = seen_in_words(made, scene.object);
    if (start.most_splats > 0) {
        Scene limited = made;
        limited.layers.front().source.splats = start.most_splats;
        text = save_text(limited, text, place);
    }
    return start.film ? with_detail(text, place, cache, progress.silent()).text : text;
}

Scene scene_from_aside(const fs::path& picture, SkyObject as, const Progress& progress) {
    constexpr std::int64_t looked_at_px = 640 * 400, made_of_px = 300 * 200;
    constexpr double aside_deg = 50.0, above_deg = 12.0;
    constexpr std::int64_t width = 160, height = 100;
    Identification found;
    PictureRequest request{as};
    request.most_texels = looked_at_px;
    const PictureScene made = picture_scene(picture, request, found, progress);
    const fs::path place = fs::absolute(picture).replace_extension(".toml");
    Scene scene = parse_scene(picture_scene_text(made, place), place);
    scene.layers.resize(1);  // without those stars that a table has
    SourceParams& source = scene.layers.front().source;
    source.structure.most_texels = made_of_px;
    source.structure.detail = 0;
    scene.output.width = width;
    scene.output.height = height;
    // All of a picture of 10 units that is seen so, and some of its depth.
    const double longest = double(std::max(made.width_px, made.height_px)),
                 wide = 10.0 * double(made.width_px) / longest,
                 high = 10.0 * double(made.height_px) / longest;
    const double aside = real::radians(aside_deg), above = real::radians(above_deg);
    scene.camera = {};
    scene.camera.projection = Projection::orthographic;
    scene.camera.position = 30.0 * glm::dvec3(real::sin(aside) * real::cos(above),
                                              real::cos(aside) * real::cos(above), -real::sin(above));
    scene.camera.up = glm::dvec3(0.0, 0.0, -1.0);
    scene.camera.height =
        std::max(1.2 * high, (wide * real::cos(aside) + 0.2 * wide) * double(height) / double(width));
    return scene;
}

double share_of(const PictureStart& start, SkyObject object) {
    const auto guess = std::ranges::find(start.guesses, object, &ObjectGuess::object);
    return guess == start.guesses.end() ? 0.0 : guess->sure;
}

std::vector<SkyObject> kinds_by_share(const PictureStart& start) {
    std::vector<SkyObject> objects;
    for (std::size_t i = 0; i < sky_object_count; ++i) objects.push_back(static_cast<SkyObject>(i));
    std::ranges::stable_sort(objects, std::ranges::greater(),
                             [&](SkyObject object) { return share_of(start, object); });
    return objects;
}

std::string choice_in_words(const std::string& choice) {
    constexpr std::pair<const char*, const char*> words[] = {{"film", "Make a film"},
                                                             {"still", "No film"},
                                                             {"part", "Part the stars"},
                                                             {"keep", "Keep the stars"},
                                                             {"whole", "Whole size"}};
    for (const auto& [name, text] : words)
        if (choice == name) return text;
    if (choice.starts_with("splats ")) return "Half size";
    const std::optional<SkyObject> object = chosen_start({}, choice).as;
    return std::string("Taken for ") + kind_words(*object).with_article;
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
