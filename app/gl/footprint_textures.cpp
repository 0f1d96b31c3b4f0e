#include "gl/footprint_textures.h"

#include <algorithm>
#include <cmath>
#include <glm/vec4.hpp>

#include "core/parallel.h"
#include "core/real.h"

namespace astrosplat {
namespace {

constexpr int profile_samples = 256;  // as in splat_vertex.glsl
constexpr int node_count = shared::NODE_COUNT;
constexpr std::size_t most_tables = 16;  // more only while one frame needs them

/// Weights of one radius at equal steps of distance from the flat inside's end to the support's.
void sample_profile(const FootprintTable& table, int node, float* samples) {
    const float radius_px = node_radius_px(static_cast<std::size_t>(node));
    Footprint footprint;
    footprint_at(table, radius_px, 0.5f, 0.5f, footprint);
    footprint.amplitude = 1.0f;
    footprint.edge_gain = 0.0f;
    const auto [lo, hi] =
        shared::profile_range(table.core, table.reach, 4.0f * table.pixel_filter_px, radius_px);
    for (int i = 0; i < profile_samples; ++i)
        samples[i] = footprint_weight(table, footprint, lo + (hi - lo) * float(i) / (profile_samples - 1));
    samples[profile_samples - 1] = 0.0f;
}

/// Mass of the profile and of its edge, relative to the light the splat shall have, with their spectra.
struct NodeTexels {
    glm::vec4 mass, edge;
};
NodeTexels node_texels(const FootprintTable& table, int node) {
    const FootprintMoments& n = table.nodes[static_cast<std::size_t>(node)].moments;
    const bool linear = table.linear_in_distance;
    const double radius_px = node_radius_px(static_cast<std::size_t>(node));
    const exact::ProfileRange range =
        exact::profile_range(table.core, table.reach, 4.0 * double(table.pixel_filter_px), radius_px);
    const double mass = exact::profile_mass(linear, range, n.mean, n.first_moment);
    const double edge = exact::edge_mass(linear, range, n.edge_mean, n.edge_first_moment);
    const double wanted = double(table.integral) * radius_px * radius_px;
    return {{float(mass / wanted), n.ripple[0], n.ripple[1], n.ripple[2]},
            {float(edge / wanted), n.edge_ripple[0], n.edge_ripple[1], n.edge_ripple[2]}};
}

}  // namespace

std::vector<FootprintSlot> FootprintTextures::prepare(const std::vector<Falloff>& falloffs,
                                                      float pixel_filter_px) {
    const auto find = [&](const Falloff& falloff) {
        return std::find_if(entries_.begin(), entries_.end(),
                            [&](const Entry& entry) { return entry.falloff == falloff; });
    };
    const auto missing = [&](const Falloff& falloff) { return find(falloff) == entries_.end(); };
    if (pixel_filter_px != pixel_filter_px_) entries_.clear();
    pixel_filter_px_ = pixel_filter_px;
    if (std::any_of(falloffs.begin(), falloffs.end(), missing)) {
        if (entries_.size() >= most_tables)
            entries_.erase(std::remove_if(entries_.begin(), entries_.end(),
                                          [&](const Entry& entry) {
                                              return std::find(falloffs.begin(), falloffs.end(),
                                                               entry.falloff) == falloffs.end();
                                          }),
                           entries_.end());
        for (const Falloff& falloff : falloffs)
            if (missing(falloff))
                entries_.push_back({falloff, make_footprint_table(falloff, pixel_filter_px)});
        upload();
    }
    std::vector<FootprintSlot> slots;
    for (const Falloff& falloff : falloffs) {
        const auto entry = find(falloff);
        slots.push_back({static_cast<int>(entry - entries_.begin()), entry->table.reach, entry->table.core,
                         entry->table.flat_core});
    }
    return slots;
}

void FootprintTextures::upload() {
    const auto tables = static_cast<std::int64_t>(entries_.size());
    std::vector<float> profiles(static_cast<std::size_t>(tables * node_count * profile_samples));
    std::vector<glm::vec4> nodes(static_cast<std::size_t>(tables * 2 * node_count));
    parallel_for(tables * node_count, [&](std::int64_t i, int) {
        const FootprintTable& table = entries_[static_cast<std::size_t>(i / node_count)].table;
        const auto node = static_cast<int>(i % node_count);
        sample_profile(table, node, &profiles[static_cast<std::size_t>(i * profile_samples)]);
        const NodeTexels texels = node_texels(table, node);
        const std::int64_t row = i / node_count * 2 * node_count;
        nodes[static_cast<std::size_t>(row + node)] = texels.mass;
        nodes[static_cast<std::size_t>(row + node_count + node)] = texels.edge;
    });
    glBindTexture(GL_TEXTURE_2D_ARRAY, profiles_.get());
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_R32F, profile_samples, node_count, static_cast<GLsizei>(tables),
                 0, GL_RED, GL_FLOAT, profiles.data());
    set_sampling(GL_TEXTURE_2D_ARRAY, GL_LINEAR);
    glBindTexture(GL_TEXTURE_2D, nodes_.get());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, node_count, static_cast<GLsizei>(2 * tables), 0, GL_RGBA,
                 GL_FLOAT, nodes.data());
    set_sampling(GL_TEXTURE_2D, GL_LINEAR);
}

void FootprintTextures::bind(int profiles_unit, int nodes_unit) const {
    bind_texture(profiles_unit, GL_TEXTURE_2D_ARRAY, profiles_.name());
    bind_texture(nodes_unit, GL_TEXTURE_2D, nodes_.name());
}

}  // namespace astrosplat
