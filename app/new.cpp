// new: a first scene around a picture.
#include "commands.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/text.h"
#include "places.h"
#include "scene/new_scene.h"
#include "scene/parameter_key.h"
#include "source/picture.h"

namespace astrosplat {
namespace {

struct NamedObject {
    const char* name;
    SkyObject object;
};
constexpr std::array<NamedObject, 4> sky_objects{{{"galaxy", SkyObject::galaxy},
                                                  {"nebula", SkyObject::nebula},
                                                  {"remnant", SkyObject::remnant},
                                                  {"field", SkyObject::field}}};

std::optional<SkyObject> object_of(const std::string& as) {
    if (as.empty()) return {};
    for (const NamedObject& named : sky_objects)
        if (named.name == as) return named.object;
    static const std::vector<std::string> names{"galaxy", "nebula", "remnant", "field", "plane"};
    throw InputError(fmt::format("--as: expected galaxy, nebula, remnant, field or plane, found '{}'{}", as,
                                 did_you_mean(as, names)));
}

std::string object_name(SkyObject object) {
    for (const NamedObject& named : sky_objects)
        if (named.object == object) return named.name;
    return "";
}

std::string bodies_text(const NewOptions& options) {
    StructureChoice choice;
    PictureScene scene = picture_scene(options.image, object_of(options.as), choice);
    scene.film = options.film;
    if (!choice.why.empty())
        log_info(fmt::format("'{}' is taken for a {}: {}; --as chooses another",
                             printable(options.image.filename().string()), object_name(choice.object),
                             choice.why));
    return picture_scene_text(scene, options.scene);
}

std::string columns_text(const NewOptions& options) {
    if (options.film) throw InputError("--film: expected a scene of bodies, found --shape or --as plane");
    if (!options.shape.empty() && !options.as.empty() && options.as != "plane")
        throw InputError(fmt::format("--shape: expected no other kind of scene, found --as {}", options.as));
    return new_scene_text(options.image, options.shape.empty() ? "plane" : options.shape, options.scene);
}

}  // namespace

int run_new(NewOptions options) {
    if (options.scene.empty()) options.scene = options.image.stem().string() + ".toml";
    require_picture(options.image);  // a scene around something else would fail at its first frame
    if (kind_of(format_by_name(options.scene)) != FileKind::scene) {
        bad_input(options.scene.string(), "", "a name ending in .toml",
                  "'" + options.scene.extension().string() + "'");
    }
    const bool columns = !options.shape.empty() || options.as == "plane";
    const std::string text = columns ? columns_text(options) : bodies_text(options);
    refuse_to_overwrite(options.scene, options.overwrite);
    prove_writable(folder_of(options.scene));
    write_file_atomically(options.scene, text, existing_of(options.overwrite));
    fmt::print("{}\n", printable(options.scene.string()));
    return exit_done;
}

}  // namespace astrosplat
