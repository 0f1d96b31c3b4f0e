// Cuts through merged trees: the nodes that look largest are divided, many at once, until there are as many
// pieces as wanted.
#include "merge/cut.h"

#include <atomic>
#include <bit>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "render/shared_render.h"
#include "splats/splat_set.h"

namespace astrosplat {
namespace {

/// Splats of one node, side by side along what looks longest of it.
struct NodeRow {
    int count = 1;
    glm::vec3 step{0.0f};  // from one to the next, layer space
    Across each;           // of one splat's part
};

/// A merged layer as the camera sees it: which nodes the frame shows, how large they look, and the splats
/// that stand for them.
class SeenLayer {
  public:
    SeenLayer(const CutLayer& layer, const CutSettings& settings) : layer_(layer), settings_(settings) {
        const glm::dmat3 rows = glm::transpose(layer.projection.camera_from_layer);
        right_ = rows[0] / double(layer.projection.radius_scale);
        up_ = rows[1] / double(layer.projection.radius_scale);
        stars_ = find_stars();
    }

    const MergedSplats& merged() const { return *layer_.merged; }
    bool is_even() const { return layer_.merging->even; }
    glm::vec3 to_camera(const glm::vec3& p) const { return astrosplat::to_camera(layer_.projection, p); }

    /// Whether the frame may show anything of the node, whose centre is p in camera space.
    bool shows(const NodeSums& sums, const glm::vec3& p) const {
        const LayerProjection& l = layer_.projection;
        const float bound = sums.bound * l.radius_scale;
        const shared::Instance at = shared::instance_of(l.lens, p);
        if (at.depth + bound < l.lens.near) return false;
        if (l.lens.far > 0.0f && at.depth - bound > l.lens.far) return false;
        if (!(at.depth - bound > l.lens.near)) return true;
        return shared::appears_in_rect(l.lens, at.x_px, at.y_px,
                                       shared::reach_px(l.lens, p, bound, l.margin_px), 0.0f, 0.0f,
                                       float(settings_.width), float(settings_.height));
    }

    /// One splat, but for a node of evenly spread ones that looks longer than wide: round ones in line with
    /// each other would overlap in one direction and leave gaps, which add up to stripes, in the other.
    /// `rows` below it: what a few of them look like is not how they are spread.
    NodeRow row_of(const NodeSums& s, std::int64_t rows) const {
        const float most = std::min(4.0f, std::sqrt(float(rows)));
        const float xx = along(s, right_, right_), yy = along(s, up_, up_), xy = along(s, right_, up_);
        const float mean = 0.5f * (xx + yy), half = 0.5f * (xx - yy), root = std::sqrt(half * half + xy * xy);
        const float longer = mean + root, shorter = std::max(0.0f, mean - root);
        NodeRow row{1, glm::vec3(0.0f), {mean, longer}};
        if (!is_even() || !(longer > 0.0f)) return row;
        const float own = float(layer_.merging->variance) * s.own;
        const float splats = s.cover * s.cover / s.squares;
        row.count =
            int(std::min({most, std::max(1.0f, splats), std::sqrt((longer + own) / (shorter + own)) + 0.5f}));
        if (row.count == 1) return row;
        const float n = float(row.count), part = longer / (n * n);
        row.each = {0.5f * (part + shorter), std::max(part, shorter)};
        const glm::vec2 axis =
            glm::normalize(half > 0.0f ? glm::vec2(root + half, xy) : glm::vec2(xy, root - half));
        // Where the splats lie that are a step farther along the axis: in depth, too.
        row.step = std::sqrt(12.0f / longer) / n * moments_times(s, axis.x * right_ + axis.y * up_);
        return row;
    }

    /// Width of an even box with the spread of what each one stands for, px; less where the splats
    /// themselves are wider than that spread, so that their places hardly show.
    float size_px(const NodeSums& sums, const NodeRow& row, const glm::vec3& p) const {
        const LayerProjection& l = layer_.projection;
        const float px_per_unit = shared::instance_of(l.lens, shared::beyond_near(l.lens, p)).px_per_unit;
        const float spread = row.each.largest;
        if (!(spread > 0.0f)) return 0.0f;
        constexpr float least = 0.01f;  // so that all are divided where nothing else limits it
        const float own = float(layer_.merging->variance) * sums.own;
        const float share = std::clamp(2.0f * spread / (spread + own), least, 1.0f);
        return share * share * std::sqrt(12.0f * spread) * l.radius_scale * px_per_unit;
    }

    /// The splat of one of the tree's rows, as row i.
    void put_splat(std::int64_t row, ShadedSplats& out, std::size_t i) const {
        const std::int64_t index = merged().place[merged().tree->rows[row]];
        const ShadedSplats& splats = merged().splats;
        out.position[i] = splats.position[index];
        out.color[i] = splats.color[index];
        out.alpha[i] = splats.alpha[index];
        out.radius[i] = splats.radius[index];
        if (layer_.relight) {
            const Relight::Factors now = layer_.relight->of(row, row + 1);
            out.color[i] *= now.light / std::max(now.cover, 1e-6f);
            out.alpha[i] = std::min(1.0f, out.alpha[i] * now.cover / now.own);
            out.radius[i] *= std::sqrt(now.own);
        }
        out.alpha[i] *= layer_.merging->render.opacity;
        CloudPlace place;
        if (is_star(splats.id[index])) {
            const float size = near_star_size(layer_.projection, to_camera(out.position[i]));
            out.color[i] /= size * size;
            out.radius[i] *= size;
        } else {
            place.radius = out.radius[i];
            place.spread = glm::vec3(child_spread * place.radius);
        }
        light_as_cloud(place, out, i);
    }

    /// A node's merged splats, as rows from `first`.
    void put_node(std::int64_t index, ShadedSplats& out, std::size_t first) const {
        NodeSums sums = merged().sums[index];
        NodeRow row = row_of(sums, merged().tree->nodes[index].size());
        if (merged().weight > 1.0f)
            for (float* spread : {&row.each.mean, &row.each.largest}) *spread *= sample_overlap;
        if (layer_.relight) relight(merged().tree->nodes[index], sums);
        const LayerProjection& l = layer_.projection;
        const LayerRender& r = layer_.merging->render;
        const float hybrid =
            shared::hybrid_amount(shared::axis_cosine(l.lens, l.axis_in_camera, to_camera(sums.centre)),
                                  r.hybrid_from_deg, r.hybrid_to_deg);
        const bool points = merged().tree->nodes[index].first >= stars_;
        const float share = 1.0f / float(row.count);
        sums.cover *= share;
        sums.squares *= share;
        sums.light *= share;
        const NodeSplat splat =
            sums.cover > 0.0f ? splat_of(*layer_.merging, sums, row.each, hybrid) : NodeSplat();
        CloudPlace place;
        place.radius = std::sqrt(sums.own);
        place.spread = glm::sqrt(glm::max(sums.spread, 0.0f) + child_spread * child_spread * sums.own);
        for (int k = 0; k < row.count; ++k) {
            const std::size_t i = first + std::size_t(k);
            const float steps = float(k) - 0.5f * float(row.count - 1);
            out.position[i] = sums.centre + steps * row.step;
            out.color[i] = splat.color;
            out.alpha[i] = splat.alpha;
            out.radius[i] = splat.radius;
            if (points)
                out.id[i] = i;
            else
                light_as_cloud(place, out, i);
        }
    }

  private:
    /// Times the overlap of others (node_splat.cpp): cells of a sample stay so large that their dips would
    /// show.
    static constexpr float sample_overlap = 1.8f;
    static constexpr float child_spread = 0.4f;  // of a splat's children along an axis, radii

    /// Stars and their spikes have a root of their own, the last one: the first of its rows.
    std::int64_t find_stars() const {
        const MergeTree& tree = *merged().tree;
        if (tree.root_count() == 0) return 0;
        const MergeNode& last = tree.nodes[tree.root_count() - 1];
        for (std::int64_t r = last.first; r < last.end; ++r)
            if (const std::int64_t i = merged().place[tree.rows[r]]; i >= 0) {
                const std::uint64_t id = merged().splats.id[i];
                return is_star(id) || is_spike(id) ? last.first : last.end;
            }
        return last.end;
    }

    void relight(const MergeNode& node, NodeSums& sums) const {
        const Relight::Factors now = layer_.relight->of(node.first, node.end);
        sums.cover *= now.cover;
        sums.squares *= now.squares;
        sums.light *= now.light;
        sums.own *= now.own;
    }

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
    std::int64_t stars_;    // rows of the tree from here on are theirs
};

/// A node of a layer, or one of its splats.
struct Piece {
    std::int64_t index;  // of the node, or the splat's in MergeTree::rows
    float size_px;       // 0: not to be divided
    std::uint16_t layer;
    std::uint8_t splats;  // that it becomes
    bool is_leaf : 1;     // and was found to be one
    bool is_splat : 1;
};

/// Rounds over all pieces, in each of which those that look larger than a limit are divided: in order of the
/// trees, which is the order of memory.
struct Cutter {
    const std::vector<SeenLayer>& layers;
    const CutSettings& settings;
    bool in_rows = std::ranges::any_of(layers, &SeenLayer::is_even);  // some nodes may be
    std::vector<Piece> pieces = {};

    std::vector<Piece> cut() {
        for (std::uint16_t l = 0; l < layers.size(); ++l)
            for (std::int64_t root = 0; root < layers[l].merged().tree->root_count(); ++root)
                add_node(root, l, endless, pieces);
        while (const std::optional<Round> round = next_round()) divide(*round);
        return std::move(pieces);
    }

    static constexpr std::int64_t pieces_at_once = 1 << 9;
    static constexpr int bins = 256;  // of sizes
    static constexpr float endless = std::numeric_limits<float>::infinity();

    struct Round {
        float limit_px;  // pieces that look larger are divided
        bool once;       // each of them, but not their parts; else all parts but leaves
    };

    std::optional<Round> next_round() const {
        // Pieces of half the size are up to eight times as many, each of up to four splats in a row:
        // while that leaves room, many sizes at once.
        constexpr double most_growth = 64.0;
        const double margin = in_rows ? 0.0625 : 0.25, least_growth = in_rows ? 2.0 : 1.5;
        float largest = 0.0f, largest_node = 0.0f;
        std::int64_t splats = 0;
        for (const Piece& piece : pieces) {
            splats += piece.splats;
            largest = std::max(largest, piece.size_px);
            if (!piece.is_leaf) largest_node = std::max(largest_node, piece.size_px);
        }
        const std::int64_t room = settings.budget - splats;
        if (room <= 0 || !(largest > settings.least_px)) return std::nullopt;
        const double growth = margin * double(settings.budget) / double(splats);
        if (growth < least_growth || !(largest_node > settings.least_px))
            return round_with_room(largest, room);
        const auto step = float(1.0 / std::cbrt(std::min(growth, most_growth)));
        return Round{std::max(settings.least_px, step * largest_node), false};
    }

    /// So few pieces are larger that dividing them has room; where it has, an eighth of all at least: parts
    /// of long ones may look larger than any other, and a round for each of these would take longer than the
    /// frame.
    std::optional<Round> round_with_room(float largest, std::int64_t room) const {
        std::vector<float> sizes(pieces.size());
        std::ranges::transform(pieces, sizes.begin(), &Piece::size_px);
        const auto eighth = sizes.begin() + std::ptrdiff_t(sizes.size() / 8);
        std::nth_element(sizes.begin(), eighth, sizes.end(), std::greater<>());
        const float lowest =
            std::max({std::min(0.8f * largest, *eighth), largest / 64.0f, settings.least_px});
        if (!(largest > lowest))
            return std::nullopt;  // a round that divides nothing would be the next one, too
        // The bits of positive numbers are in their order, and nearly in equal ratios.
        const std::uint64_t low = std::bit_cast<std::uint32_t>(lowest),
                            range = std::bit_cast<std::uint32_t>(largest) - low + 1;
        std::array<std::atomic<std::int64_t>, bins> more{};
        parallel_each(pieces.size(), pieces_at_once, [&](std::size_t i) {
            if (!(pieces[i].size_px > lowest)) return;
            const std::uint64_t above = std::bit_cast<std::uint32_t>(pieces[i].size_px) - low;
            more[above * bins / range].fetch_add(more_of(pieces[i]), std::memory_order_relaxed);
        });
        std::uint64_t bin = bins;
        while (bin > 0 && (room -= more[bin - 1]) >= 0) --bin;
        if (bin == bins) return std::nullopt;
        const std::uint64_t first = low + (bin * range + bins - 1) / bins;
        return Round{std::max(lowest, std::bit_cast<float>(std::uint32_t(first - 1))), true};
    }

    void divide(const Round& round) {
        const auto count = std::int64_t(pieces.size());
        std::vector<std::vector<Piece>> parts(std::size_t((count + pieces_at_once - 1) / pieces_at_once));
        parallel_chunks(count, pieces_at_once, [&](std::int64_t begin, std::int64_t end, int) {
            std::vector<Piece>& part = parts[begin / pieces_at_once];
            for (std::int64_t i = begin; i < end; ++i) {
                if (round.once && pieces[i].size_px > round.limit_px)
                    add_parts(pieces[i], endless, part);
                else
                    add_piece(pieces[i], round.once ? endless : round.limit_px, part);
            }
        });
        pieces.clear();
        for (const std::vector<Piece>& part : parts) pieces.insert(pieces.end(), part.begin(), part.end());
    }

    const MergeNode& node_of(const Piece& piece) const {
        return layers[piece.layer].merged().tree->nodes[piece.index];
    }
    /// Splats besides this one's that there are at most when it is divided.
    std::int64_t more_of(const Piece& piece) const {
        const MergeNode& node = node_of(piece);
        if (node.is_leaf()) return node.end - node.first - piece.splats;
        const SeenLayer& layer = layers[piece.layer];
        const auto splats_of = [&](std::int64_t part) {
            const MergedSplats& merged = layer.merged();
            return layer.row_of(merged.sums[part], merged.tree->nodes[part].size()).count;
        };
        return splats_of(node.children) + splats_of(node.children + 1) - piece.splats;
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
        const MergedSplats& merged = layers[piece.layer].merged();
        const MergeNode& node = node_of(piece);
        if (!node.is_leaf()) {
            add_node(node.children, piece.layer, limit_px, out);
            add_node(node.children + 1, piece.layer, limit_px, out);
            return;
        }
        if (merged.weight > 1.0f)
            return out.push_back({piece.index, 0.0f, piece.layer, piece.splats, true, false});
        for (std::int64_t r = node.first; r < node.end; ++r) {
            if (merged.place[merged.tree->rows[r]] >= 0) out.push_back({r, 0.0f, piece.layer, 1, true, true});
        }
    }

    void add_node(std::int64_t index, std::uint16_t l, float limit_px, std::vector<Piece>& out) const {
        const SeenLayer& layer = layers[l];
        const NodeSums& sums = layer.merged().sums[index];
        if (!(sums.cover > 0.0f)) return;
        const glm::vec3 p = layer.to_camera(sums.centre);
        if (!layer.shows(sums, p)) return;
        const MergedSplats& merged = layer.merged();
        const MergeNode& node = merged.tree->nodes[index];
        if (node.size() == 1 && !(merged.weight > 1.0f))
            return out.push_back({node.first, 0.0f, l, 1, true, true});
        const NodeRow row = layer.row_of(sums, node.size());
        add_piece({index, layer.size_px(sums, row, p), l, std::uint8_t(row.count), false, false}, limit_px,
                  out);
    }
};

void resize(ShadedSplats& splats, std::size_t size) {
    for_each_array(splats, [&](auto& array) { array.resize(size); });
}

}  // namespace

std::vector<ShadedSplats> cut_splats(std::span<const CutLayer> layers, const CutSettings& settings) {
    std::vector<SeenLayer> seen;
    for (const CutLayer& layer : layers) seen.emplace_back(layer, settings);
    const std::vector<Piece> pieces = Cutter{seen, settings}.cut();
    std::vector<std::size_t> counts(layers.size(), 0);
    Buffer<std::size_t> places(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        places[i] = counts[pieces[i].layer];
        counts[pieces[i].layer] += pieces[i].splats;
    }
    std::vector<ShadedSplats> cut(layers.size());
    for (std::size_t l = 0; l < layers.size(); ++l) resize(cut[l], counts[l]);
    parallel_each(pieces.size(), 1 << 11, [&](std::size_t i) {
        const std::size_t layer = pieces[i].layer;
        if (pieces[i].is_splat)
            seen[layer].put_splat(pieces[i].index, cut[layer], places[i]);
        else
            seen[layer].put_node(pieces[i].index, cut[layer], places[i]);
    });
    return cut;
}

}  // namespace astrosplat
