// new: a first scene around a picture.
#include "new.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/text.h"
#include "output/image_info.h"
#include "places.h"
#include "scene/new_scene.h"
#include "source/fits.h"

namespace astrosplat {
namespace {

// A scene around something else would fail at its first frame: better said now.
void check_picture(const std::filesystem::path& file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) bad_input(file.string(), "", "a picture", "a folder");
    if (!std::ifstream(file)) bad_input(file.string(), "", "a picture", "nothing that can be read");
    if (!is_fits(file)) read_image_info(file);
}

}  // namespace

int run_new(const NewOptions& options) {
    check_picture(options.image);
    if (options.scene.extension() != ".toml") {
        bad_input(options.scene.string(), "", "a name ending in .toml",
                  "'" + options.scene.extension().string() + "'");
    }
    const std::string text = new_scene_text(options.image, options.shape, options.scene);
    refuse_to_overwrite(options.scene, options.overwrite);
    prove_writable(folder_of(options.scene));
    write_file_atomically(options.scene, text, options.overwrite ? Existing::replace : Existing::keep);
    fmt::print("{}\n", printable(options.scene.string()));
    return exit_done;
}

}  // namespace astrosplat
