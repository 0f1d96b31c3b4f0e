// What looks largest is divided, many at once, until there are as many pieces as wanted.
#include "merge/cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/parallel.h"
#include "merge/seen_layer.h"

namespace astrosplat {
namespace {

/// A node of a layer, or one of its splats.
struct Piece {
    std::int64_t index;
    float size_px;  // 0: not to be divided
    std::uint16_t layer;
    std::uint8_t dots;  // that it becomes
    bool is_leaf : 1;   // and was found to be one
    bool is_splat : 1;
};

/// Rounds over all pieces, in each of which those that look larger than a limit are divided: in order of the
/// trees, which is the order of memory.
class Cutter {
  public:
    Cutter(const std::vector<SeenLayer>& layers, const CutSettings& settings)
        : layers_(layers),
          settings_(settings),
          in_rows_(std::ranges::any_of(layers, &SeenLayer::is_lattice)) {}

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

    std::optional<Round> next_round() const {
        // Pieces of half the size are up to eight times as many, each of up to four dots on a lattice: while
        // that leaves room, many sizes at once.
        constexpr double most_growth = 64.0;
        const double margin = in_rows_ ? 0.0625 : 0.25, least_growth = in_rows_ ? 2.0 : 1.5;
        float largest = 0.0f, largest_node = 0.0f;
        std::int64_t dots = 0;
        for (const Piece& piece : pieces_) {
            dots += piece.dots;
            largest = std::max(largest, piece.size_px);
            if (!piece.is_leaf) largest_node = std::max(largest_node, piece.size_px);
        }
        const std::int64_t room = settings_.budget - dots;
        if (room <= 0 || !(largest > settings_.least_px)) return std::nullopt;
        const double growth = margin * static_cast<double>(settings_.budget) / static_cast<double>(dots);
        if (growth < least_growth || !(largest_node > settings_.least_px))
            return round_with_room(largest, room);
        const auto step = static_cast<float>(1.0 / std::cbrt(std::min(growth, most_growth)));
        return Round{std::max(settings_.least_px, step * largest_node), false};
    }

    /// So few pieces are larger that dividing them has room.
    std::optional<Round> round_with_room(float largest, std::int64_t room) const {
        const float lowest = std::max(0.8f * largest, settings_.least_px);
        if (!(largest > lowest))
            return std::nullopt;  // a round that divides nothing would be the next one, too
        const float bins_per_px = bins / (largest - lowest);
        std::array<std::int64_t, bins> more{};
        for (const Piece& piece : pieces_)
            if (piece.size_px > lowest)
                more[std::min(bins - 1, static_cast<int>((piece.size_px - lowest) * bins_per_px))] +=
                    more_of(piece);
        int bin = bins;
        while (bin > 0 && (room -= more[bin - 1]) >= 0) --bin;
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
    /// Dots beside this one's that there are at most when it is divided.
    std::int64_t more_of(const Piece& piece) const {
        const MergeNode& node = node_of(piece);
        if (node.is_leaf()) return node.end - node.first - piece.dots;
        const SeenLayer& layer = layers_[piece.layer];
        const NodeSums* const parts = &layer.merged().sums[node.children];
        return layer.dots_of(parts[0]).count + layer.dots_of(parts[1]).count - piece.dots;
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
        if (merged.weight > 1.0f)
            return out.push_back({piece.index, 0.0f, piece.layer, piece.dots, true, false});
        for (std::int64_t r = node.first; r < node.end; ++r) {
            const std::int64_t splat = merged.place[merged.tree->rows[r]];
            if (splat >= 0) out.push_back({splat, 0.0f, piece.layer, 1, true, true});
        }
    }

    void add_node(std::int64_t index, std::uint16_t l, float limit_px, std::vector<Piece>& out) const {
        const SeenLayer& layer = layers_[l];
        const NodeSums& sums = layer.merged().sums[index];
        if (!(sums.cover > 0.0f)) return;
        const glm::vec3 p = layer.to_camera(sums.centre);
        if (!layer.shows(sums, p)) return;
        const DotRow row = layer.dots_of(sums);
        add_piece({index, layer.size_px(sums, row, p), l, static_cast<std::uint8_t>(row.count), false, false},
                  limit_px, out);
    }

    const std::vector<SeenLayer>& layers_;
    const CutSettings& settings_;
    bool in_rows_;  // some nodes may be
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
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        places[i] = counts[pieces[i].layer];
        counts[pieces[i].layer] += pieces[i].dots;
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
