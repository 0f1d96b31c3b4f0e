// new: a first scene around a picture.
#include "new.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file_format.h"
#include "core/text.h"
#include "places.h"
#include "scene/new_scene.h"
#include "source/picture.h"

namespace astrosplat {
int run_new(const NewOptions& options) {
    require_picture(options.image);  // a scene around something else would fail at its first frame
    if (kind_of(format_by_name(options.scene)) != FileKind::scene) {
        bad_input(options.scene.string(), "", "a name ending in .toml",
                  "'" + options.scene.extension().string() + "'");
    }
    const std::string text = new_scene_text(options.image, options.shape, options.scene);
    refuse_to_overwrite(options.scene, options.overwrite);
    prove_writable(folder_of(options.scene));
    write_file_atomically(options.scene, text, existing_of(options.overwrite));
    fmt::print("{}\n", printable(options.scene.string()));
    return exit_done;
}

}  // namespace astrosplat
