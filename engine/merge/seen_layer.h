// A merged layer as a camera sees it. In: CutLayer and a frame. Out: which nodes the frame shows, how large
// they look, and the dots that stand for them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include "merge/cloud_light.h"
#include "merge/cut.h"
#include "render/shared_render.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Dots of one node, side by side along what looks longest of it.
struct DotRow {
    int count = 1;
    glm::vec3 step{0.0f};  // from one to the next, layer space
    Across each;           // of one dot's part
};

/// A layer seen by the camera.
class SeenLayer {
  public:
    SeenLayer(const CutLayer& layer, const CutSettings& settings) : layer_(layer), settings_(settings) {
        const glm::dmat3 rows = glm::transpose(layer.projection.camera_from_layer);
        right_ = rows[0] / double(layer.projection.radius_scale);
        up_ = rows[1] / double(layer.projection.radius_scale);
    }

    const MergedSplats& merged() const { return *layer_.merged; }
    bool is_lattice() const { return layer_.dots->lattice; }
    glm::vec3 to_camera(const glm::vec3& p) const {
        return glm::vec3(layer_.projection.camera_from_layer * glm::dvec3(p) +
                         layer_.projection.origin_in_camera);
    }

    /// Whether the frame may show anything of the node, whose centre is p in camera space.
    bool shows(const NodeSums& sums, const glm::vec3& p) const {
        const LayerProjection& l = layer_.projection;
        const float bound = sums.bound * l.radius_scale;
        const shared::Instance at = shared::instance_of(l.lens, p);
        if (at.depth + bound < l.lens.near) return false;
        if (l.lens.far > 0.0f && at.depth - bound > l.lens.far) return false;
        if (!(at.depth - bound > l.lens.near)) return true;
        return shared::appears_in_rect(
            l.lens, at.x_px, at.y_px, shared::reach_px(l.lens, p, bound, l.margin_px), 0.0f, 0.0f,
            static_cast<float>(settings_.width), static_cast<float>(settings_.height));
    }

    /// One dot, but for a node of a lattice that looks longer than wide: round dots in line with each other
    /// would overlap in one direction and leave gaps, which add up to stripes, in the other.
    DotRow dots_of(const NodeSums& s) const {
        constexpr float most = 4.0f;
        const float xx = along(s, right_, right_), yy = along(s, up_, up_), xy = along(s, right_, up_);
        const float mean = 0.5f * (xx + yy), half = 0.5f * (xx - yy), root = std::sqrt(half * half + xy * xy);
        const float longer = mean + root, shorter = std::max(0.0f, mean - root);
        DotRow row{1, glm::vec3(0.0f), {mean, longer}};
        if (!is_lattice() || !(longer > 0.0f)) return row;
        const float own = static_cast<float>(layer_.dots->variance) * s.own;
        const float splats = s.cover * s.cover / s.squares;
        row.count = static_cast<int>(
            std::min({most, std::max(1.0f, splats), std::sqrt((longer + own) / (shorter + own)) + 0.5f}));
        if (row.count == 1) return row;
        const float n = static_cast<float>(row.count), part = longer / (n * n);
        row.each = {0.5f * (part + shorter), std::max(part, shorter)};
        const glm::vec2 axis =
            glm::normalize(half > 0.0f ? glm::vec2(root + half, xy) : glm::vec2(xy, root - half));
        // Where the splats lie that are a step farther along the axis: in depth, too.
        row.step = std::sqrt(12.0f / longer) / n * moments_times(s, axis.x * right_ + axis.y * up_);
        return row;
    }

    /// Width of an even box with the spread of each dot's splats, px; less where the splats themselves are
    /// wider than that spread, so that their places hardly show.
    float size_px(const NodeSums& sums, const DotRow& row, const glm::vec3& p) const {
        const LayerProjection& l = layer_.projection;
        const float px_per_unit = shared::instance_of(l.lens, shared::beyond_near(l.lens, p)).px_per_unit;
        const float spread = row.each.largest;
        if (!(spread > 0.0f)) return 0.0f;
        constexpr float least = 0.01f;  // so that all are divided where nothing else limits it
        const float own = static_cast<float>(layer_.dots->variance) * sums.own;
        const float share = std::clamp(2.0f * spread / (spread + own), least, 1.0f);
        return share * share * std::sqrt(12.0f * spread) * l.radius_scale * px_per_unit;
    }

    /// One of its splats, as row i.
    void put_splat(std::int64_t index, ShadedSplats& out, std::size_t i) const {
        const ShadedSplats& splats = merged().splats;
        out.position[i] = splats.position[index];
        out.color[i] = splats.color[index];
        out.alpha[i] = splats.alpha[index] * layer_.dots->render.opacity;
        out.radius[i] = splats.radius[index];
        CloudPlace place;
        if (is_star(splats.id[index])) {
            const float size = near_star_size(layer_.projection, to_camera(out.position[i]));
            out.color[i] /= size * size;
            out.radius[i] *= size;
        } else {
            place.radius = splats.radius[index];
            place.spread = glm::vec3(child_spread * place.radius);
        }
        light_as_cloud(place, out, i);
    }

    /// A node's dots, as rows from `first`.
    void put_node(std::int64_t index, ShadedSplats& out, std::size_t first) const {
        NodeSums sums = merged().sums[index];
        const DotRow row = dots_of(sums);
        const LayerProjection& l = layer_.projection;
        const LayerRender& r = layer_.dots->render;
        const float hybrid =
            shared::hybrid_amount(shared::axis_cosine(l.lens, l.axis_in_camera, to_camera(sums.centre)),
                                  r.hybrid_from_deg, r.hybrid_to_deg);
        const float share = 1.0f / static_cast<float>(row.count);
        sums.cover *= share;
        sums.squares *= share;
        sums.light *= share;
        const Dot dot = make_dot(*layer_.dots, sums, row.each, hybrid);
        CloudPlace place;
        place.radius = std::sqrt(sums.own);
        place.spread = glm::sqrt(glm::max(sums.spread, 0.0f) + child_spread * child_spread * sums.own);
        for (int k = 0; k < row.count; ++k) {
            const std::size_t i = first + static_cast<std::size_t>(k);
            const float steps = static_cast<float>(k) - 0.5f * static_cast<float>(row.count - 1);
            out.position[i] = sums.centre + steps * row.step;
            out.color[i] = dot.color;
            out.alpha[i] = dot.alpha;
            out.radius[i] = dot.radius;
            light_as_cloud(place, out, i);
        }
    }

  private:
    static constexpr float child_spread = 0.4f;  // of a splat's children along an axis, radii

    void light_as_cloud(CloudPlace place, ShadedSplats& out, std::size_t i) const {
        place.centre = out.position[i];
        place.in_camera = to_camera(place.centre);
        place.alpha = out.alpha[i];
        place.color = out.color[i];
        out.color[i] *= cloud_light(layer_.projection, place);
        out.id[i] = i;
    }

    /// Second moments times a direction, and along two of them.
    static glm::vec3 moments_times(const NodeSums& s, const glm::vec3& a) {
        return s.spread * a + glm::vec3(s.skew.z * a.y + s.skew.y * a.z, s.skew.z * a.x + s.skew.x * a.z,
                                        s.skew.y * a.x + s.skew.x * a.y);
    }
    static float along(const NodeSums& s, const glm::vec3& a, const glm::vec3& b) {
        return glm::dot(s.spread, a * b) + s.skew.x * (a.y * b.z + a.z * b.y) +
               s.skew.y * (a.z * b.x + a.x * b.z) + s.skew.z * (a.x * b.y + a.y * b.x);
    }

    const CutLayer& layer_;
    const CutSettings& settings_;
    glm::vec3 right_, up_;  // of the frame, in layer space
};

}  // namespace astrosplat
