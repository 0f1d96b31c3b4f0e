// new: a first scene around a picture.
#include <fmt/format.h>

#include <fstream>

#include "commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "places.h"
#include "scene/new_scene.h"

namespace astrosplat {

int run_new(const NewOptions& options) {
    if (!std::ifstream(options.image))
        bad_input(options.image.string(), "", "a picture", "nothing that can be read");
    if (options.scene.extension() != ".toml") {
        bad_input(options.scene.string(), "", "a name ending in .toml",
                  "'" + options.scene.extension().string() + "'");
    }
    const std::string text = new_scene_text(options.image, options.shape, options.scene);
    refuse_to_overwrite(options.scene, options.overwrite);
    prove_writable(folder_of(options.scene));
    write_file_atomically(options.scene, text);
    fmt::print("{}\n", options.scene.string());
    return exit_done;
}

}  // namespace astrosplat
