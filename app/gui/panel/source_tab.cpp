// Source: what the splats of the selected layer are made of. Everything here but the transform generates
// them again, and the tab says so.
#include "gui/panel/source_tab.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/file_format.h"
#include "gui/panel/levels.h"
#include "gui/panel/plot.h"
#include "gui/panel/section.h"
#include "gui/panel/words.h"
#include "gui/theme.h"

namespace astrosplat::panel {
namespace {

bool is_fits(const LayerParams& layer) {
    for (const MeshInput& mesh : layer.source.meshes)
        for (const auto& texture : mesh.texture) {
            const FileFormat* const format = format_by_name(texture);
            if (format && format->id == "fits") return true;
        }
    return false;
}

std::string files_state(const LayerParams& layer) {
    if (layer.source.kind == SourceKind::splats) return layer.source.file.filename().string();
    if (layer.source.kind == SourceKind::stars) return layer.source.stars.catalogue.filename().string();
    if (layer.source.meshes.empty()) return "none";
    return layer.source.meshes.front().mesh.filename().string();
}

void state_lines(Context& context) {
    const LayerStatus& status = context.layer_status();
    const float width = ImGui::GetContentRegionAvail().x;
    if (status.loading) {
        const std::string text =
            status.found > 0 ? "Generating, " + splat_count(status.found) : std::string("Generating");
        if (progress_line(width, std::max(status.progress, 0.001f), text, "Cancel"))
            context.commands.push_back({Command::Kind::cancel_load, {}, "", context.view.layer});
    } else if (status.stale) {
        if (progress_line(width, 0.0f, "Source changed", "Regenerate"))
            context.commands.push_back({Command::Kind::regenerate, {}, "", context.view.layer});
    } else {
        note("Changing these generates the splats anew.");
    }
    if (!status.error.empty()) note(status.error, color::error);
    ImGui::Dummy({0.0f, px(4)});
}

void meshes_rows(Context& context) {
    const std::size_t count = context.layer().source.meshes.size();
    const std::size_t layer = context.view.layer;
    for (std::size_t i = 0; i < count; ++i) {
        ImGui::PushID(static_cast<int>(i));
        const std::string head = fmt::format("Mesh {}", i + 1);
        if (count > 1 && element_head(head.c_str()))
            edit(context, context.prefix, "Remove mesh", [&](Scene& scene) {
                auto& meshes = scene.layers[layer].source.meshes;
                meshes.erase(meshes.begin() + static_cast<std::ptrdiff_t>(i));
            });
        const std::string key = fmt::format("source.meshes.{}.", i);
        layer_row(context, key + "mesh");
        layer_row(context, key + "texture");
        if (context.layer().source.meshes[i].mesh == "relief") layer_row(context, key + "relief");
        ImGui::PopID();
    }
    if (add_line("Add mesh"))
        edit(context, context.prefix, "Add mesh", [&](Scene& scene) {
            scene.layers[layer].source.meshes.push_back({"plane", {}, 0.15});
        });
}

void stars_rows(Context& context) {
    layer_row(context, "source.catalogue");
    layer_row(context, "source.unit");
    layer_row(context, "source.limit");
    layer_row(context, "source.zero_point");
    layer_row(context, "source.along");
    layer_row(context, "source.spread");
    layer_row(context, "source.psf");
}

void files_section(Context& context) {
    const LayerParams& layer = context.layer();
    if (!section(context, "Files", files_state(layer), true)) return;
    layer_row(context, "source.kind");
    if (layer.source.kind == SourceKind::mesh) {
        meshes_rows(context);
        layer_row(context, "source.uv");
    } else if (layer.source.kind == SourceKind::splats) {
        layer_row(context, "source.file");
    } else {
        stars_rows(context);
    }
}

void picture_section(Context& context) {
    const LayerParams& layer = context.layer();
    const bool fits = is_fits(layer);
    if (layer.source.kind != SourceKind::mesh || !section(context, "Picture", fits ? "FITS" : "", fits))
        return;
    edit_levels(context);
    layer_row(context, "source.black");
    layer_row(context, "source.white");
    layer_row(context, "source.stretch");
    if (fits || layer.source.texture.stretch == TextureSettings::Stretch::asinh)
        layer_row(context, "source.softening");
    if (fits) {
        layer_row(context, "source.hdu");
        layer_row(context, "source.plane");
    }
    layer_row(context, "source.colorspace");
    layer_row(context, "source.alpha");
    layer_row(context, "source.unpremultiply");
    layer_row(context, "source.filter");
    layer_row(context, "source.wrap");
}

void splats_section(Context& context) {
    const LayerParams& layer = context.layer();
    const std::int64_t splats = context.layer_status().splats;
    if (!section(context, "Splats", splats > 0 ? short_count(splats) : "", true)) return;
    const bool mesh = layer.source.kind == SourceKind::mesh;
    if (layer.source.kind != SourceKind::splats && !layer.source.voxels && layer.source.voxel_size == 0.0)
        layer_row(context, "source.count");
    if (mesh) {
        layer_row(context, "source.max_distance");
        layer_row(context, "source.voxels");
        if (!layer.source.voxels) layer_row(context, "source.voxel_size");
        layer_row(context, "source.buffer");
        layer_row(context, "source.jitter");
    }
    layer_row(context, "source.seed");
}

void placement_section(Context& context) {
    const LayerTransform& t = context.layer().transform;
    const bool still = t == LayerTransform();
    if (!section(context, "Placement", still ? "as it lies" : fmt::format("x {}", figures(t.scale)))) return;
    layer_row(context, "transform.translate");
    layer_row(context, "transform.rotate");
    layer_row(context, "transform.scale");
    layer_row(context, "axis");
}

void layer_section(Context& context) {
    if (!section(context, "Layer", context.layer().name)) return;
    layer_row(context, "name");
    layer_row(context, "visible");
    layer_row(context, "preset");
}

}  // namespace

void source_tab(Context& context) {
    state_lines(context);
    files_section(context);
    picture_section(context);
    splats_section(context);
    placement_section(context);
    layer_section(context);
}

}  // namespace astrosplat::panel
