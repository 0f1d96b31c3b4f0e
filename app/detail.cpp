// detail: where the camera of a scene comes close, its pictures get detail below their texels.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "command.h"
#include "core/error.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/text.h"
#include "exit.h"
#include "scene/detail_tiles.h"
#include "scene/save.h"

namespace astrosplat {
namespace {

constexpr std::int64_t enough_texels = 65536;  // only the pictures' shape counts

struct DetailOptions {
    std::optional<std::string> splats;
    bool none = false;  // takes detail away
};

bool is_of_bodies(const LayerParams& layer) {
    return layer.source.kind == SourceKind::mesh && layer.source.structure.kind != StructureKind::columns;
}

Report to_report(const DetailTiles& found) {
    return {{"one_octave", number(found.shares[1])},
            {"two_octaves", number(found.shares[2])},
            {"more_splats", number(std::round(found.more_splats))}};
}

int run_detail(const CommandOptions& options, const DetailOptions& own) {
    constexpr double most_splats = 1e9;
    const fs::path& file = options.input;
    Scene scene = load_scene(file);
    const std::int64_t limit = own.none     ? 0
                               : own.splats ? option_count("--splats", *own.splats, "a number of splats", 0,
                                                           std::int64_t(most_splats))
                                            : usual_detail_splats;
    if (std::ranges::none_of(scene.layers, is_of_bodies))
        throw InputError(printable(file.string()) +
                         ": expected a layer of bodies (source.structure), found none");
    const Report report = set_detail(scene, limit, options.cache);
    const fs::path target = options.output.value_or(file);
    if (options.output) refuse_to_overwrite(target, options.overwrite);
    prove_writable(folder_of(target));
    write_file_atomically(target, save_text(scene, read_file(file), target), Existing::replace);
    print_report(report, options.json);
    return exit_done;
}

}  // namespace

Report set_detail(Scene& scene, std::int64_t most_splats, const SetCache& cache) {
    Report report = Report::object();
    for (LayerParams& layer : scene.layers) {
        if (!is_of_bodies(layer)) continue;
        StructureParams& structure = layer.source.structure;
        structure.detail_tiles.clear();
        structure.detail = 0;
        DetailTiles found;
        if (most_splats > 0)
            found = detail_tiles(scene, layer, load_meshes(cache, layer.source, stoppable(), enough_texels),
                                 double(most_splats));
        structure.detail_tiles = found.tiles;
        structure.detail = found.shares[2] > 0.0 ? 2 : found.shares[1] > 0.0 ? 1 : 0;
        report[layer.name] = to_report(found);
    }
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
    add_json(command, call.options);
}

}  // namespace astrosplat
