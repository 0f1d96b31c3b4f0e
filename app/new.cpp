// new: a first scene around a picture, of bodies in depth or of columns on a shape.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "command.h"
#include "core/error.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/text.h"
#include "edit/picture_start.h"
#include "exit.h"
#include "scene/new_scene.h"
#include "scene/parameter_key.h"
#include "source/picture.h"

namespace astrosplat {
namespace {

struct NewOptions {
    std::string as;      // an object of the sky, or plane; empty: found from the picture and its file
    std::string object;  // its name, "M 104"; may be empty
    std::string shape;   // of a scene of columns; empty: a scene of bodies
    bool film = false;
    fs::path starless, stars;  // a picture without its stars, and these
};

std::optional<SkyObject> object_of(const std::string& as) {
    if (as.empty()) return {};
    std::vector<std::string> names = all_names<SkyObject>();
    if (const auto found = std::ranges::find(names, as); found != names.end())
        return static_cast<SkyObject>(found - names.begin());
    names.emplace_back("plane");
    throw InputError(
        fmt::format("--as: expected {}, found '{}'{}", alternatives(names), as, did_you_mean(as, names)));
}

const CatalogueObject* object_by_name(const std::string& name) {
    if (name.empty()) return nullptr;
    if (const CatalogueObject* const known = object_named(name)) return known;
    std::vector<std::string> names;
    for (const CatalogueObject& object : object_catalogue())
        names.insert(names.end(), object.names.begin(), object.names.end());
    throw InputError(
        fmt::format("--object: expected a name in the table of objects, such as 'M 104', found {}{}",
                    shown(name), did_you_mean(name, names)));
}

/// "galaxy", or "galaxy (72 %), perhaps nebula".
std::string in_words(const std::vector<ObjectGuess>& guesses) {
    constexpr double surely = 0.9;
    const std::string best(name_of(guesses[0].object));
    if (guesses.size() < 2 || guesses[0].sure >= surely) return best;
    return fmt::format("{} ({:.0f} %), perhaps {}", best, 100.0 * guesses[0].sure,
                       name_of(guesses[1].object));
}

void say(const fs::path& picture, const Identification& found) {
    const std::string name = printable(picture.filename().string()), &type = found.metadata.type;
    if (!found.why.empty())
        log_info(fmt::format("'{}' is taken for: {}; {}; --as chooses another", name, in_words(found.guesses),
                             found.why));
    if (!type.empty() && type != "Observation" && type != "Photographic")
        log_info(fmt::format("'{}' is no observation: its metadata says {}", name, shown(type)));
}

/// Where it lies on the sky and how large it is there, as far as the file says.
void add_sky(const ObjectMetadata& metadata, const PictureScene& scene, Report& report) {
    const auto width = double(scene.width_px), height = double(scene.height_px);
    const std::optional<double> degrees_per_px = degrees_per_px_of(metadata, width, height);
    if (const auto& place = metadata.sky_position)
        report["sky"] = {{"right_ascension", number((*place)[0])}, {"declination", number((*place)[1])}};
    if (metadata.north_angle) report["north_angle"] = number(*metadata.north_angle);
    if (!degrees_per_px) return;
    report["width_degrees"] = number(*degrees_per_px * width);
    if (scene.light_years_per_px > 0.0) report["width_ly"] = number(scene.light_years_per_px * width);
}

Report to_report(const Identification& found, const PictureScene& scene) {
    Report report{{"object", name_of(found.guesses[0].object)},
                  {"sure", number(found.guesses[0].sure)},
                  {"because", found.why},
                  {"else", Report::object()}};
    for (std::size_t i = 1; i < found.guesses.size(); ++i)
        report["else"][std::string(name_of(found.guesses[i].object))] = number(found.guesses[i].sure);
    if (found.known) report["names"] = found.known->names;
    if (found.distance_ly) report["distance_ly"] = number(*found.distance_ly);
    if (!found.metadata.credit.empty()) report["credit"] = found.metadata.credit;
    add_sky(found.metadata, scene, report);
    return report;
}

struct BodiesScene {
    std::string text;
    Report report;
};
BodiesScene bodies_scene(const fs::path& picture, const fs::path& place, const NewOptions& options,
                         const SetCache& cache, const fs::path& stars) {
    Identification found;
    PictureScene scene = picture_scene(
        picture, {object_of(options.as), object_by_name(options.object), options.starless, stars}, found);
    scene.film = options.film;
    say(options.starless.empty() ? picture : options.starless, found);
    BodiesScene made{picture_scene_text(scene, place), to_report(found, scene)};
    if (!options.film) return made;
    FilmText film = with_detail(made.text, place, cache, stoppable());
    made.report["detail"] = to_report(film.detail);
    made.text = std::move(film.text);
    return made;
}

std::string columns_text(const fs::path& picture, const fs::path& place, const NewOptions& options) {
    if (options.film) throw InputError("--film: expected a scene of bodies, found --shape or --as plane");
    if (!options.object.empty())
        throw InputError("--object: expected a scene of bodies, found --shape or --as plane");
    if (!options.shape.empty() && !options.as.empty() && options.as != "plane")
        throw InputError(fmt::format("--shape: expected no other kind of scene, found --as {}", options.as));
    const std::string shape = options.shape.empty() ? "plane" : options.shape;
    const bool as_large = shape == "plane" || shape == "relief";  // as the picture in both directions
    return new_scene_text(picture, shape, place, as_large ? scale_text_of(picture) : "");
}

int run_new(const CommandOptions& options, const NewOptions& own) {
    const bool pair = !own.starless.empty() || !own.stars.empty();
    if (pair && (own.starless.empty() || own.stars.empty() || !options.input.empty()))
        throw InputError("new: expected IMAGE, or --starless A and --stars B, found a part of both");
    if (!pair && options.input.empty())
        throw InputError("new: expected IMAGE, or --starless A and --stars B");
    const fs::path& picture = pair ? own.stars : options.input;
    const fs::path scene = options.output.value_or((pair ? own.starless : picture).stem().string() + ".toml");
    require_picture(picture);  // a scene around something else would fail at its first frame
    if (kind_of(format_by_name(scene)) != FileKind::scene)
        bad_input(scene.string(), "", "a name ending in .toml", "'" + scene.extension().string() + "'");
    const bool columns = !own.shape.empty() || own.as == "plane";
    if (pair && columns)
        throw InputError("--starless: expected a scene of bodies, found --shape or --as plane");
    refuse_to_overwrite(scene, options.overwrite);
    prove_writable(folder_of(scene));
    fs::path table;
    if (pair) {
        require_picture(own.starless);
        table = folder_of(scene) / (scene.stem().string() + "_stars.csv");
        refuse_to_overwrite(table, options.overwrite);
        write_star_table(own.stars, own.starless, table, existing_of(options), stoppable());
    }
    const BodiesScene made = columns ? BodiesScene{columns_text(picture, scene, own), Report::object()}
                                     : bodies_scene(picture, scene, own, options.cache, table);
    write_file_atomically(scene, made.text, existing_of(options));
    if (options.json) {
        Report report{{"scene", scene.string()}};
        report.update(made.report);
        print_report(report, true);
    } else {
        fmt::print("{}\n", printable(scene.string()));
    }
    return exit_done;
}

}  // namespace

void add_new(CLI::App& app, Invocation& call) {
    const std::string kinds = fmt::format("{}|plane", fmt::join(all_names<SkyObject>(), "|"));
    auto [command, own] = add_command(app, call, "new", "Writes a scene for a picture", run_new);
    add_value(command, "IMAGE", call.options.input, "IMAGE", "The picture");
    add_value(
        command, "--starless", own.starless, "A",
        "In place of IMAGE, with --stars: a picture without its stars, as StarNet, StarXTerminator or Siril "
        "part them; the sum of both is the picture");
    add_value(command, "--stars", own.stars, "B", "The stars alone");
    add_output(command, call.options, "SCENE",
               "The scene file to write (default: the picture's name with .toml, in this folder)")
        ->required(false);
    add_value(command, "--as", own.as, kinds,
              "What the picture shows (default: by what its file says, and by its light)");
    add_value(command, "--object", own.object, "NAME",
              "The object that it shows, such as 'M 104': one of the table of objects");
    add_json(command, call.options);
    command.add_flag("--film", own.film, "With a camera move of ten seconds");
    add_value(command, "--shape", own.shape, "plane|relief|disk|sphere",
              "Columns on this mesh instead of bodies");
}

}  // namespace astrosplat
