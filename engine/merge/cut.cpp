// What looks largest is divided, many at once, until there are as many pieces as wanted.
#include "merge/cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "core/parallel.h"
#include "core/real.h"
#include "merge/cloud_light.h"
#include "render/shared_render.h"
#include "splats/star_id.h"

namespace astrosplat {
namespace {

/// A node of a layer, or one of its splats.
struct Piece {
    std::int64_t index;
    float size_px;  // 0: not to be divided
    std::uint16_t layer;
    bool is_leaf;  // and was found to be one
    bool is_splat;
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

    Across across(const NodeSums& s) const {
        const float xx = along(s, right_, right_), yy = along(s, up_, up_), xy = along(s, right_, up_);
        const float mean = 0.5f * (xx + yy), half = 0.5f * (xx - yy);
        return {mean, mean + std::sqrt(half * half + xy * xy)};
    }

    /// Width of an even box with the spread of the node's splats, px; less where the splats themselves are
    /// wider than that spread, so that their places hardly show.
    float size_px(const NodeSums& sums, const glm::vec3& p) const {
        const LayerProjection& l = layer_.projection;
        const float px_per_unit = shared::instance_of(l.lens, shared::beyond_near(l.lens, p)).px_per_unit;
        const float spread = across(sums).largest;
        if (!(spread > 0.0f)) return 0.0f;
        constexpr float least = 0.01f;  // so that all are divided where nothing else limits it
        const float own = static_cast<float>(layer_.dots->variance) * sums.own;
        const float share = std::clamp(2.0f * spread / (spread + own), least, 1.0f);
        return share * share * std::sqrt(12.0f * spread) * l.radius_scale * px_per_unit;
    }

    void put(const Piece& piece, ShadedSplats& out, std::size_t i) const {
        const ShadedSplats& splats = merged().splats;
        CloudPlace place;
        if (piece.is_splat) {
            place.radius = is_star(splats.id[piece.index]) ? 0.0f : splats.radius[piece.index];
            place.spread = glm::vec3(child_spread * place.radius);
            out.position[i] = splats.position[piece.index];
            out.color[i] = splats.color[piece.index];
            out.alpha[i] = splats.alpha[piece.index] * layer_.dots->render.opacity;
            out.radius[i] = splats.radius[piece.index];
        } else {
            const NodeSums& sums = merged().sums[piece.index];
            const LayerProjection& l = layer_.projection;
            place.radius = std::sqrt(sums.own);
            place.spread = glm::sqrt(glm::max(sums.spread, 0.0f) + child_spread * child_spread * sums.own);
            const float cosine = shared::axis_cosine(l.lens, l.axis_in_camera, to_camera(sums.centre));
            const LayerRender& r = layer_.dots->render;
            const float hybrid = shared::hybrid_amount(cosine, r.hybrid_from_deg, r.hybrid_to_deg);
            const Dot dot = make_dot(*layer_.dots, sums, across(sums), hybrid);
            out.position[i] = sums.centre;
            out.color[i] = dot.color;
            out.alpha[i] = dot.alpha;
            out.radius[i] = dot.radius;
        }
        place.centre = out.position[i];
        place.in_camera = to_camera(place.centre);
        place.alpha = out.alpha[i];
        place.color = out.color[i];
        out.color[i] *= cloud_light(layer_.projection, place);
        out.id[i] = i;
    }

  private:
    static constexpr float child_spread = 0.4f;  // of a splat's children along an axis, radii

    /// Second moment along two directions.
    static float along(const NodeSums& s, const glm::vec3& a, const glm::vec3& b) {
        return glm::dot(s.spread, a * b) + s.skew.x * (a.y * b.z + a.z * b.y) +
               s.skew.y * (a.z * b.x + a.x * b.z) + s.skew.z * (a.x * b.y + a.y * b.x);
    }

    const CutLayer& layer_;
    const CutSettings& settings_;
    glm::vec3 right_, up_;  // of the frame, in layer space
};

/// Rounds over all pieces, in each of which those that look larger than a limit are divided: in order of the
/// trees, which is the order of memory.
class Cutter {
  public:
    Cutter(const std::vector<SeenLayer>& layers, const CutSettings& settings)
        : layers_(layers), settings_(settings) {}

    std::vector<Piece> cut() {
        for (std::uint16_t l = 0; l < layers_.size(); ++l)
            for (std::int64_t root = 0; root < layers_[l].merged().tree->root_count(); ++root)
                add_node(root, l, endless, pieces_);
        while (const std::optional<Round> round = next_round()) divide(*round);
        return std::move(pieces_);
    }

  private:
    static constexpr std::int64_t pieces_at_once = 1 << 9;
    static constexpr int bins = 256;  // of sizes
    static constexpr float endless = std::numeric_limits<float>::infinity();

    struct Round {
        float limit_px;  // pieces that look larger are divided
        bool once;       // each of them, but not their parts; else all parts but leaves
    };

    std::int64_t room() const { return settings_.budget - static_cast<std::int64_t>(pieces_.size()); }

    std::optional<Round> next_round() const {
        // Pieces of half the size are up to eight times as many: while that leaves room, many sizes at once.
        constexpr double most_growth = 64.0, margin = 0.25, least_growth = 1.5;
        float largest = 0.0f, largest_node = 0.0f;
        for (const Piece& piece : pieces_) {
            largest = std::max(largest, piece.size_px);
            if (!piece.is_leaf) largest_node = std::max(largest_node, piece.size_px);
        }
        if (room() <= 0 || !(largest > settings_.least_px)) return std::nullopt;
        const double growth =
            margin * static_cast<double>(settings_.budget) / static_cast<double>(pieces_.size());
        if (growth < least_growth || !(largest_node > settings_.least_px)) return round_with_room(largest);
        const auto step = static_cast<float>(1.0 / std::cbrt(std::min(growth, most_growth)));
        return Round{std::max(settings_.least_px, step * largest_node), false};
    }

    /// So few pieces are larger that dividing them has room.
    std::optional<Round> round_with_room(float largest) const {
        const float lowest = std::max(0.8f * largest, settings_.least_px);
        if (!(largest > lowest))
            return std::nullopt;  // a round that divides nothing would be the next one, too
        const float bins_per_px = bins / (largest - lowest);
        std::array<std::int64_t, bins> more{};
        for (const Piece& piece : pieces_)
            if (piece.size_px > lowest)
                more[std::min(bins - 1, static_cast<int>((piece.size_px - lowest) * bins_per_px))] +=
                    more_of(piece);
        std::int64_t left = room();
        int bin = bins;
        while (bin > 0 && (left -= more[bin - 1]) >= 0) --bin;
        if (bin == bins) return std::nullopt;
        return Round{lowest + static_cast<float>(bin) / bins_per_px, true};
    }

    void divide(const Round& round) {
        const auto count = static_cast<std::int64_t>(pieces_.size());
        std::vector<std::vector<Piece>> parts(
            static_cast<std::size_t>((count + pieces_at_once - 1) / pieces_at_once));
        parallel_chunks(count, pieces_at_once, [&](std::int64_t begin, std::int64_t end, int) {
            std::vector<Piece>& part = parts[begin / pieces_at_once];
            for (std::int64_t i = begin; i < end; ++i) {
                if (round.once && pieces_[i].size_px > round.limit_px)
                    add_parts(pieces_[i], endless, part);
                else
                    add_piece(pieces_[i], round.once ? endless : round.limit_px, part);
            }
        });
        pieces_.clear();
        for (const std::vector<Piece>& part : parts) pieces_.insert(pieces_.end(), part.begin(), part.end());
    }

    const MergeNode& node_of(const Piece& piece) const {
        return layers_[piece.layer].merged().tree->nodes[piece.index];
    }
    /// Pieces beside this one that there are at most when it is divided.
    std::int64_t more_of(const Piece& piece) const {
        const MergeNode& node = node_of(piece);
        return node.is_leaf() ? node.end - node.first - 1 : 1;
    }

    /// Divided until its parts are within the limit, or leaves.
    void add_piece(Piece piece, float limit_px, std::vector<Piece>& out) const {
        if (piece.size_px > limit_px && !piece.is_leaf) {
            piece.is_leaf = node_of(piece).is_leaf();
            if (!piece.is_leaf) return add_parts(piece, limit_px, out);
        }
        out.push_back(piece);
    }

    void add_parts(const Piece& piece, float limit_px, std::vector<Piece>& out) const {
        const MergedSplats& merged = layers_[piece.layer].merged();
        const MergeNode& node = node_of(piece);
        if (!node.is_leaf()) {
            add_node(node.children, piece.layer, limit_px, out);
            add_node(node.children + 1, piece.layer, limit_px, out);
            return;
        }
        if (merged.weight > 1.0f) return out.push_back({piece.index, 0.0f, piece.layer, true, false});
        for (std::int64_t r = node.first; r < node.end; ++r) {
            const std::int64_t splat = merged.place[merged.tree->rows[r]];
            if (splat >= 0) out.push_back({splat, 0.0f, piece.layer, true, true});
        }
    }

    void add_node(std::int64_t index, std::uint16_t l, float limit_px, std::vector<Piece>& out) const {
        const SeenLayer& layer = layers_[l];
        const NodeSums& sums = layer.merged().sums[index];
        if (!(sums.cover > 0.0f)) return;
        const glm::vec3 p = layer.to_camera(sums.centre);
        if (!layer.shows(sums, p)) return;
        add_piece({index, layer.size_px(sums, p), l, false, false}, limit_px, out);
    }

    const std::vector<SeenLayer>& layers_;
    const CutSettings& settings_;
    std::vector<Piece> pieces_;
};

void resize(ShadedSplats& splats, std::size_t size) {
    for_each_array(splats, [&](auto& array) { array.resize(size); });
}

}  // namespace

std::vector<ShadedSplats> cut_splats(std::span<const CutLayer> layers, const CutSettings& settings) {
    std::vector<SeenLayer> seen;
    for (const CutLayer& layer : layers) seen.emplace_back(layer, settings);
    const std::vector<Piece> pieces = Cutter(seen, settings).cut();
    std::vector<std::size_t> counts(layers.size(), 0);
    Buffer<std::size_t> places(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) places[i] = counts[pieces[i].layer]++;
    std::vector<ShadedSplats> cut(layers.size());
    for (std::size_t l = 0; l < layers.size(); ++l) resize(cut[l], counts[l]);
    parallel_each(pieces.size(), 1 << 11, [&](std::size_t i) {
        const std::size_t layer = pieces[i].layer;
        seen[layer].put(pieces[i], cut[layer], places[i]);
    });
    return cut;
}

}  // namespace astrosplat
