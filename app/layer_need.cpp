#include "layer_need.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "bodies/picture_size.h"
#include "core/error.h"
#include "core/file_format.h"
#include "generate/generate.h"
#include "generate/lattice.h"
#include "interrupt.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"
#include "sets/kept.h"
#include "sets/load_source.h"
#include "splat_files/native_blocks.h"
#include "splat_files/splat_file.h"
#include "streamed/streamed_set.h"

namespace astrosplat {
namespace {

constexpr std::int64_t shaded_bytes = 40;
// Of captures: a row of a file with normals; and beside what all have shape and radius, harmonics and colours
// by direction.
constexpr std::int64_t capture_row_bytes = 68, harmonics_row_bytes = 180;
constexpr std::int64_t shape_bytes = 68, harmonics_bytes = 204;
constexpr std::int64_t sorting_bytes = 32;  // a row of a file whose rows are not in order of id
constexpr std::int64_t streamed_bytes_per_block = 128 * shaded_bytes + 256;  // sample, bounds
constexpr std::int64_t catalogue_bytes_per_star = 100;                       // HYG; Hipparcos, compressed

// More than any machine holds, few enough that bytes of many layers still fit 63 bits.
constexpr std::int64_t most_splats = 1'000'000'000'000'000;

struct Expected {
    std::int64_t splats = 0;
    std::int64_t making_bytes = 0;  // while the set is made or read; 0: what it takes then
    std::shared_ptr<const NativeBlocks> file = nullptr;  // of kind splats, where it is .splats
    bool has_radius = false;
    bool has_shapes = false;      // captures: their look leaves the set whole, as it has the shapes
    std::int64_t held_bytes = 0;  // by the set and by what is shaded, beyond what all have
};

Expected expected_columns(const SourceParams& source, const std::vector<TexturedMesh>& meshes) {
    Bounds box;
    for (const TexturedMesh& textured : meshes) box.add(bounds(textured.mesh));
    const double max_distance = resolved_max_distance(source, box);
    const Lattice lattice = make_lattice(source, meshes, max_distance);
    return {static_cast<std::int64_t>(expected_splats(source, lattice, meshes, max_distance)),
            columns_memory_bytes(meshes, lattice, max_distance)};
}

/// Of a file that cannot be read nothing: the reader will say why.
Expected expected_file(const std::filesystem::path& path) try {
    Expected expected;
    const std::vector<std::string> attributes = splat_attributes(path);
    const auto has = [&](const char* name) {
        return std::ranges::find(attributes, name) != attributes.end();
    };
    const std::string_view format = format_of_file(path)->id;
    if (format == "splats") {
        expected.file = std::make_shared<NativeBlocks>(path);
        expected.splats = expected.file->splats();
        expected.making_bytes = expected.file->bytes() + expected.splats * sorting_bytes;
    } else if (format == "gltf") {
        const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(path));
        expected.splats = bytes / (capture_row_bytes + (has("harmonics") ? harmonics_row_bytes : 0));
    } else {
        expected.splats = splat_count(path);
    }
    expected.has_radius = has("radius") || has("scale");
    expected.has_shapes = has("scale");
    if (expected.has_shapes)
        expected.held_bytes = expected.splats * (shape_bytes + (has("harmonics") ? harmonics_bytes : 0));
    return expected;
} catch (const InputError&) {
    return {};
}

Expected expected_of(const SetCache& cache, const LayerParams& layer) {
    const SourceParams& source = layer.source;
    if (source.kind == SourceKind::splats) return expected_file(source.file);
    if (source.kind == SourceKind::stars) {
        if (!source.stars.along.empty()) return {source.count};
        std::error_code ignored;
        const auto size = std::filesystem::file_size(source.stars.catalogue, ignored);
        return {ignored ? 0 : static_cast<std::int64_t>(size) / catalogue_bytes_per_star};
    }
    const bool bodies = source.structure.kind != StructureKind::columns;
    if (!bodies && has_automatic_voxels(source) && source.splats <= 0)
        return {source.count, columns_memory_bytes(source.count)};
    std::vector<TexturedMesh> meshes =
        load_meshes(cache, source, Progress{{}, &interrupted()}, most_texels_read(source, room_for_bodies()));
    if (!bodies) return expected_columns(source, meshes);
    const BodiesPlan plan = plan_bodies(source, std::move(meshes), layer.name);
    const std::int64_t dots = expected_dots(plan.meshes, plan.structure);
    return {std::min(dots, source.splats > 0 ? source.splats : most_splats),
            bodies_memory_bytes(plan.meshes, dots)};
}

}  // namespace

LayerNeed need_of(const BatchPlan& plan, const LayerParams& layer, const SampledRun::Layer* sampled) {
    const bool is_kept = sampled && !sampled->is_made && layer.source.kind == SourceKind::mesh;
    Expected expected = is_kept ? Expected{} : expected_of(plan.cache, layer);
    if (sampled) expected.splats = sampled->splats;
    if (sampled && sampled->has_radius) expected.has_radius = true;
    expected.splats = std::min(expected.splats, most_splats);
    const Look look = look_of(layer);
    const OptionalColumns wanted = columns_read(look);
    const std::int64_t row = 40 + (wanted.uv ? 8 : 0) + (wanted.mesh ? 4 : 0) + (expected.has_radius ? 4 : 0);
    LayerNeed need{&layer, expected.splats, expected.has_shapes};
    need.making = std::max(expected.making_bytes, expected.splats * row);
    const bool used_up = is_shaded_alike(plan.scene, layer.name) && !expected.has_shapes;
    need.held = expected.splats * (used_up ? row : row + shaded_bytes);
    need.reads_pictures = !is_kept && layer.source.kind == SourceKind::mesh;
    need.making += expected.held_bytes;
    need.held += expected.held_bytes;
    if (expected.file)
        need.streamed = static_cast<std::int64_t>(expected.file->size()) * streamed_bytes_per_block;
    need.may_stream =
        expected.file && !is_encoded(layer.render) && why_not_streamed(*expected.file, look).empty();
    return need;
}

}  // namespace astrosplat
