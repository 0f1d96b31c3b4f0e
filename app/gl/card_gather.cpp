// The splats of a group: what the card projects itself, and what the processor has projected for it.
#include <fmt/format.h>

#include "core/parallel.h"
#include "gl/card_parts.h"
#include "render/shape.h"

namespace astrosplat {

using namespace card;

namespace {

/// What the processor has projected of some of a layer's splats, in their order.
struct GivenPart {
    Buffer<ScreenSplat> splats;
    std::vector<float> shapes;  // twelve numbers each, of those that are not round
};

/// Splats of one star or Gaussian, in the order of ties.
void order_ties(Buffer<ScreenSplat>& splats) {
    for (std::size_t i = 0, end; i < splats.size(); i = end) {
        for (end = i + 1; end < splats.size() && splats[end].index == splats[i].index;) ++end;
        if (end - i > 1)
            std::sort(splats.begin() + std::ptrdiff_t(i), splats.begin() + std::ptrdiff_t(end),
                      [](const ScreenSplat& a, const ScreenSplat& b) { return in_front_of(a, b); });
    }
}

/// A footprint that is not round, as card_project.glsl reads it.
void add_shape(const FootprintTable& table, const Shape& shape, const ScreenSplat& splat,
               std::vector<float>& to) {
    const ShapedFootprint found = shaped_footprint_at(table, shape, splat.x_px, splat.y_px);
    const Footprint& f = found.round;
    const Ellipse e = ellipse_of(shape);
    const float support_px =
        shape_support_px(shape, {table.reach, 4.0f * table.pixel_filter_px, table.variance});
    to.insert(to.end(),
              {f.lo, f.edge_gain, f.amplitude, f.t, found.xx, found.xy, found.yy, 0.0f, f.scale,
               float(f.node_a - table.nodes.data()), support_px, float(std::sqrt(e.larger * e.smaller))});
}

}  // namespace

/// Splats of a layer that level of detail divides, and stars that stay points close by: what becomes of them,
/// as the card projects it.
bool Card::make_children(const FrameJob& job, Group& group, std::size_t number, const Kept& kept) {
    const std::int64_t n = job.layers[number].size();
    if (!begins_.reserve(4 * n) || !sums_.reserve(4 * (n / scanned + 64)) || !child_total_.reserve(8))
        return false;
    const LayerProjection& layer = job.projections[number];
    if (layer.lod) {
        const LodTable::Numbers& numbers = layer.lod->numbers();
        const auto fill = [](CardBuffer& to, const auto& from) {
            return to.fill(from.data(), std::ssize(from) * std::int64_t(sizeof from[0]));
        };
        if (!fill(child_radius_, numbers.radius) || !fill(child_fading_, numbers.fading) ||
            !fill(child_steady_, numbers.steady))
            return false;
    }
    CardBuffer& to = children_[number];
    const auto run = [&](int pass, std::int64_t threads) {
        const GlProgram& p = program("card_children.glsl", fmt::format("PASS {}", pass));
        set_children(p, job, group, number);
        Uniforms{p.name()}("wanted", static_cast<GLuint>(threads));
        const auto& a = kept.arrays;
        bind({&a[0], &a[1], &a[2], &a[3], &begins_, &child_total_, &to, &child_radius_, &child_fading_,
              &child_steady_});
        (kept.ids ? *kept.ids : a[0]).bind(14);
        dispatch(p, groups_for(threads, group_size));
    };
    const GLuint none[2] = {};
    GLuint total[2] = {};
    glNamedBufferSubData(child_total_.name(), 0, 8, none);
    run(0, n);
    glGetNamedBufferSubData(child_total_.name(), 0, 8, total);
    constexpr std::int64_t bytes_each = sizeof(ScreenSplat);
    const std::int64_t count = total[0];
    if (total[1] > 0 || bytes_each * count > most_bytes_) return false;
    if (count == 0) {
        children_.erase(number);
        return true;
    }
    if (count * bytes_each > to.bytes() && bytes() + count * bytes_each > room()) return false;
    if (!counts_.reserve(sizeof(Counts)) || !to.reserve(bytes_each * count)) return false;
    counts_.bind(0);
    scan(begins_, static_cast<GLuint>(n), 0, 0, 0);
    run(1, count);
    group.splats.push_back({number, nullptr, &to, count, 0, 0, 0});
    group.ranked = true;
    return true;
}

/// Projects a layer's splats by the processor.
bool Card::give(const FrameJob& job, Group& group, std::size_t number) {
    constexpr std::int64_t chunk = 1024;
    const LayerProjection& layer = job.projections[number];
    const FootprintTable& table = *job.fold_layers[number].footprints;
    const Region& r = group.region;
    const ScreenRect rect{float(r.x), float(r.y), float(r.x + r.width), float(r.y + r.height)};
    const std::int64_t count = job.layers[number].size();
    std::vector<GivenPart> parts(static_cast<std::size_t>(groups_for(count, chunk)));
    parallel_chunks(count, chunk, [&](std::int64_t begin, std::int64_t end, int) {
        job.progress.check();
        auto& [splats, numbers] = parts[begin / chunk];
        Buffer<Shape> shapes;
        astrosplat::project(layer, begin, end, rect, splats, shapes);
        order_ties(splats);
        for (ScreenSplat& splat : splats)
            if (!is_round(splat)) {
                const Shape shape = shapes[shape_number(splat)];
                set_shape_number(splat, static_cast<std::uint32_t>(numbers.size() / 12));
                add_shape(table, shape, splat, numbers);
            }
    });
    const std::int64_t first = std::ssize(given_);
    std::vector<std::pair<std::int64_t, std::int64_t>> begins;  // of a part's splats and shapes
    std::int64_t end = first, shapes = std::ssize(shapes_);
    for (const GivenPart& part : parts) {
        begins.emplace_back(end, shapes);
        end += std::ssize(part.splats);
        shapes += std::ssize(part.shapes);
    }
    given_.resize(static_cast<std::size_t>(end));
    shapes_.resize(static_cast<std::size_t>(shapes));
    parallel_each(std::ssize(parts), 1, [&](std::int64_t i) {
        const auto before = static_cast<std::uint32_t>(begins[i].second / 12);
        for (ScreenSplat& splat : parts[i].splats)
            if (!is_round(splat)) set_shape_number(splat, before + shape_number(splat));
        std::ranges::copy(parts[i].splats, given_.begin() + begins[i].first);
        std::ranges::copy(parts[i].shapes, shapes_.begin() + begins[i].second);
        parts[i] = {};
    });
    const std::int64_t splats = std::ssize(given_) - first, limit = job.settings.memory_limit_bytes;
    if (limit > 0 && std::ssize(given_) * std::int64_t(sizeof(ScreenSplat)) > limit) return false;
    if (splats > 0) group.splats.push_back({number, nullptr, &given_splats_, splats, first, 0, 0});
    return true;
}

/// All splats of the group, layer by layer: what the card projects, and what the processor has to.
bool Card::gather(const FrameJob& job, std::size_t number, Group& group) {
    given_.clear();
    shapes_.clear();
    std::int64_t rank = 0;
    for (const std::size_t l : job.groups[number].layers) {
        const RenderLayer& layer = job.layers[l];
        const LayerProjection& projection = job.projections[l];
        const std::size_t first = group.splats.size();
        if (is_given(layer)) {
            if (!give(job, group, l)) return false;
        } else if (layer.size() > 0) {
            const bool divides = projection.lod || projection.star_distance > 0.0f;
            const Kept* const kept = keep(layer, divides);
            if (!kept) return false;
            group.splats.push_back({l, kept, nullptr, layer.size(), 0, 0, 0});
            if (divides && !make_children(job, group, l, *kept)) return false;
        }
        for (std::size_t i = first; i < group.splats.size(); ++i)
            group.splats[i].first_rank = static_cast<GLuint>(rank);
        rank += is_given(layer) && group.splats.size() > first ? group.splats[first].count : layer.size();
    }
    for (Splats& splats : group.splats) {
        splats.first_group = group.splat_groups;
        group.count += splats.count;
        group.splat_groups += static_cast<GLuint>(groups_for(splats.count, group_size));
    }
    return send(given_.data(), std::ssize(given_) * std::int64_t(sizeof(ScreenSplat)), given_splats_) &&
           send(shapes_.data(), 4 * std::ssize(shapes_), given_shapes_);
}

}  // namespace astrosplat
