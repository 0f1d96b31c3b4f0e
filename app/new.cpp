// new: a first scene around a picture, of bodies in depth or of columns on a shape.

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "cli.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/text.h"
#include "exit.h"
#include "scene/new_scene.h"
#include "scene/parameter_key.h"
#include "source/picture.h"

namespace astrosplat {
namespace fs = std::filesystem;
namespace {

struct NewOptions {
    std::string as;     // an object of the sky, or plane; empty: chosen by looking at the picture
    std::string shape;  // of a scene of columns; empty: a scene of bodies
    bool film = false;
};

constexpr std::array sky_objects{
    std::pair{SkyObject::galaxy, "galaxy"}, std::pair{SkyObject::nebula, "nebula"},
    std::pair{SkyObject::remnant, "remnant"}, std::pair{SkyObject::field, "field"}};

std::optional<SkyObject> object_of(const std::string& as) {
    if (as.empty()) return {};
    std::vector<std::string> names;
    for (const auto& [object, name] : sky_objects) {
        if (as == name) return object;
        names.emplace_back(name);
    }
    names.emplace_back("plane");
    throw InputError(
        fmt::format("--as: expected {}, found '{}'{}", alternatives(names), as, did_you_mean(as, names)));
}

std::string object_name(SkyObject object) {
    for (const auto& [known, name] : sky_objects)
        if (known == object) return name;
    return "";
}

std::string bodies_text(const fs::path& picture, const fs::path& place, const NewOptions& options) {
    StructureChoice choice;
    PictureScene scene = picture_scene(picture, object_of(options.as), choice);
    scene.film = options.film;
    if (!choice.why.empty())
        log_info(fmt::format("'{}' is taken for a {}: {}; --as chooses another",
                             printable(picture.filename().string()), object_name(choice.object), choice.why));
    return picture_scene_text(scene, place);
}

std::string columns_text(const fs::path& picture, const fs::path& place, const NewOptions& options) {
    if (options.film) throw InputError("--film: expected a scene of bodies, found --shape or --as plane");
    if (!options.shape.empty() && !options.as.empty() && options.as != "plane")
        throw InputError(fmt::format("--shape: expected no other kind of scene, found --as {}", options.as));
    return new_scene_text(picture, options.shape.empty() ? "plane" : options.shape, place);
}

int run_new(const CommandOptions& options, const NewOptions& own) {
    const fs::path& picture = options.input;
    const fs::path scene = options.output.value_or(picture.stem().string() + ".toml");
    require_picture(picture);  // a scene around something else would fail at its first frame
    if (kind_of(format_by_name(scene)) != FileKind::scene)
        bad_input(scene.string(), "", "a name ending in .toml", "'" + scene.extension().string() + "'");
    const bool columns = !own.shape.empty() || own.as == "plane";
    const std::string text = columns ? columns_text(picture, scene, own) : bodies_text(picture, scene, own);
    refuse_to_overwrite(scene, options.overwrite);
    prove_writable(folder_of(scene));
    write_file_atomically(scene, text, existing_of(options));
    fmt::print("{}\n", printable(scene.string()));
    return exit_done;
}

}  // namespace

void add_new(CLI::App& app, Invocation& call) {
    auto [command, own] = add_command(app, call, "new", "Writes a scene for a picture", run_new);
    add_input(command, call.options, "IMAGE", "The picture");
    add_output(command, call.options, "SCENE",
               "The scene file to write (default: the picture's name with .toml, in this folder)")
        ->required(false);
    add_value(command, "--as", own.as, "galaxy|nebula|remnant|field|plane",
              "What the picture shows (default: by looking at it)");
    command.add_flag("--film", own.film, "With a camera move of ten seconds");
    add_value(command, "--shape", own.shape, "plane|relief|disk|sphere",
              "Columns on this mesh instead of bodies");
}

}  // namespace astrosplat
