// detail: where the camera of a scene comes close, its pictures get detail below their texels.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "command.h"
#include "core/color.h"
#include "core/error.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/text.h"
#include "exit.h"
#include "image/channels.h"
#include "scene/detail_tiles.h"
#include "scene/save.h"
#include "source/write_image.h"

namespace astrosplat {
namespace {

struct DetailOptions {
    std::optional<std::string> splats;
    bool none = false;  // takes detail away
    std::optional<fs::path> image;
};

/// The first picture of a layer, grey and dim, with its tiles of one octave in blue, of two in orange.
void write_levels(const fs::path& file, const TexturedMesh& mesh, const std::string& tiles) {
    const Image picture = brightest_channel(mesh.textures.front().image);
    const auto columns = std::int64_t(std::min(tiles.find(' '), tiles.size())),
               rows = std::int64_t(tiles.size() + 1) / (columns + 1);
    constexpr float tints[3][3] = {{0.5f, 0.5f, 0.5f}, {0.4f, 0.7f, 1.6f}, {1.6f, 0.8f, 0.3f}};
    std::vector<unsigned char> rgba;
    for (std::int64_t y = 0; y < picture.height; ++y)
        for (std::int64_t x = 0; x < picture.width; ++x) {
            const float grey = display_srgb(*picture.at(x, y));
            const std::int64_t column = x * columns / picture.width, row = y * rows / picture.height;
            const int level = tiles.empty() ? 0 : tiles[std::size_t(row * (columns + 1) + column)] - '0';
            for (const float tint : tints[level])
                rgba.push_back(static_cast<unsigned char>(255.0f * std::min(1.0f, (0.1f + grey) * tint)));
            rgba.push_back(255);
        }
    write_image(file, picture.width, picture.height, rgba);
}

/// Of all layers of bodies; where there are several, their names are put before the ending.
void write_images(const fs::path& file, const Scene& scene, const CommandOptions& options) {
    const auto count = std::ranges::count_if(scene.layers, has_bodies);
    for (const LayerParams& layer : scene.layers) {
        if (!has_bodies(layer)) continue;
        fs::path own = file;
        if (count > 1)
            own.replace_filename(file.stem().string() + "." + layer.name + file.extension().string());
        refuse_to_overwrite(own, options.overwrite);
        const auto meshes = load_meshes(options.cache, layer.source, stoppable(), enough_texels);
        if (!meshes.empty() && !meshes.front().textures.empty())
            write_levels(own, meshes.front(), layer.source.structure.detail_tiles);
    }
}

int run_detail(const CommandOptions& options, const DetailOptions& own) {
    constexpr double most_splats = 1e9;
    const fs::path& file = options.input;
    Scene scene = load_scene(file);
    const std::int64_t limit = own.none     ? 0
                               : own.splats ? option_count("--splats", *own.splats, "a number of splats", 0,
                                                           std::int64_t(most_splats))
                                            : usual_detail_splats;
    const auto found = set_detail(scene, double(limit), options.cache, stoppable());
    if (found.empty())
        throw InputError(printable(file.string()) +
                         ": expected a layer of bodies (source.structure), found none");
    const fs::path target = options.output.value_or(file);
    if (options.output) refuse_to_overwrite(target, options.overwrite);
    prove_writable(folder_of(target));
    if (own.image) write_images(*own.image, scene, options);
    write_file_atomically(target, save_text(scene, read_file(file), target), Existing::replace);
    print_report(to_report(found), options.json);
    return exit_done;
}

}  // namespace

Report to_report(std::span<const LayerDetail> found) {
    Report report = Report::object();
    for (const auto& [layer, tiles] : found)
        report[layer] = {{"one_octave", number(tiles.shares[1])},
                         {"two_octaves", number(tiles.shares[2])},
                         {"more_splats", number(std::round(tiles.more_splats))}};
    return report;
}

void add_detail_command(CLI::App& app, Invocation& call) {
    auto [command, own] = add_command(
        app, call, "detail", "Gives pictures detail below their texels where a scene's camera comes close",
        run_detail);
    add_input(command, call.options, "SCENE",
              "The scene: its source.structure.detail and detail_tiles are set");
    add_output(command, call.options, "SCENE", "Writes it there instead")->required(false);
    add_value(command, "--splats", own.splats, "N", "At most about so many more splats (default: 6000000)");
    command.add_flag("--none", own.none, "Takes detail away");
    add_value(command, "--image", own.image, "FILE",
              "Also writes the picture with its tiles in false colours: one octave blue, two orange");
    add_json(command, call.options);
}

}  // namespace astrosplat
