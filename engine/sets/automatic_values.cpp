// The formulas stay where they are used: placement.h for heights, the meshes' box for planar coordinates.
#include "sets/automatic_values.h"

#include "bodies/placement.h"
#include "bodies/uv_surface.h"
#include "source/textured_mesh.h"

namespace astrosplat {
namespace {

constexpr std::int64_t enough_texels = 65536;  // only the pictures' shape counts

bool has_automatic_height(const SourceParams& source) {
    return source.structure.kind != StructureKind::columns && source.structure.height == 0.0;
}

bool has_automatic_width(const SourceParams& source) {
    const bool planar =
        source.uv == UvMode::planar_xy || source.uv == UvMode::planar_xz || source.uv == UvMode::planar_yz;
    return planar && source.uv_width == 0.0;
}

double body_height(const SourceParams& source, const TexturedMesh& mesh) {
    if (mesh.textures.empty()) return 0.0;
    const Texture& texture = mesh.textures.front();
    const bool known = texture.file_width > 0;
    const std::int64_t width = known ? texture.file_width : texture.image.width,
                       height = known ? texture.file_height : texture.image.height;
    const UvSurface surface(mesh.mesh, 0, width, height, false, mesh.camera ? &*mesh.camera : nullptr);
    const double texels_per_unit = surface.texels_per_unit();
    if (!(texels_per_unit > 0.0)) return 0.0;
    StructureParams params = source.structure;
    if (mesh.mesh.name != "plane") params.margin = 0.0;  // as add_margins has it
    const auto beyond = static_cast<std::int64_t>(2.0 * params.margin * static_cast<double>(width));
    return placement_without_fields(width + beyond, height + beyond, params, texels_per_unit).height /
           texels_per_unit;
}

}  // namespace

AutomaticValues automatic_values(const SourceParams& source, const Progress& progress) {
    AutomaticValues values;
    if (source.kind != SourceKind::mesh || !(has_automatic_height(source) || has_automatic_width(source)))
        return values;
    SourceParams unprepared = source;  // which changes no picture's shape
    unprepared.texture.prepare = {};
    const std::vector<TexturedMesh> meshes =
        load_meshes(unprepared, {{}, progress.cancelled}, {make_prepared, {}, enough_texels});
    if (meshes.empty()) return values;
    if (has_automatic_height(source)) values.body_height = body_height(source, meshes.front());
    if (has_automatic_width(source))
        values.uv_width = bounds(meshes).extent()[source.uv == UvMode::planar_yz ? 2 : 0];
    return values;
}

}  // namespace astrosplat
