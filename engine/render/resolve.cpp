#include "render/resolve.h"

#include "core/color.h"

namespace astrosplat {
namespace {

bool is_isolated(const LayerRender& render) { return render.isolate || render.blend == Blend::lighten; }

FoldKind kind_of(std::span<const RenderLayer> layers, const std::vector<std::size_t>& members, bool aovs) {
    if (members.size() == 1 && layers[members[0]].render.blend == Blend::lighten &&
        !layers[members[0]].render.holdout)
        return FoldKind::lighten;
    const auto all = [&](Blend blend) {
        return std::ranges::all_of(members, [&](std::size_t i) {
            return layers[i].render.blend == blend && !layers[i].render.holdout && !layers[i].absorbs;
        });
    };
    if (aovs) return FoldKind::general;
    return all(Blend::over) ? FoldKind::over : all(Blend::add) ? FoldKind::add : FoldKind::general;
}

/// The light of a group at one pixel and the share of what lies behind that it lets through,
/// per channel (3: alpha).
struct GroupPixel {
    float color[3], alpha;
    float through[4];
};

GroupPixel group_pixel(const BlendGroup& group, const TilePlanes& planes, std::size_t i) {
    GroupPixel p;
    for (int k = 0; k < 3; ++k) p.color[k] = planes.color[k][i];
    if (group.encoded)
        for (float& color : p.color)
            if (color != 0.0f) color = float(real::srgb_to_linear(color));
    p.alpha = planes.alpha[i];
    for (int k = 0; k < 4; ++k)
        p.through[k] = group.kind == FoldKind::over  ? planes.transmittance[0][i]
                       : group.kind == FoldKind::add ? 1.0f
                                                     : planes.transmittance[k][i];
    if (!group.isolated || group.holdout || group.blend == Blend::absorb) return p;
    const auto through = [&](float light) {
        return group.blend == Blend::add ? 1.0f : 1.0f - (group.blend == Blend::screen ? light : p.alpha);
    };
    float hidden = 0.0f;
    for (int k = 0; k < 3; ++k) {
        const float light = std::min(1.0f, p.color[k]);
        hidden += light;
        p.through[k] = through(light);
    }
    p.through[3] = through(hidden / 3.0f);
    if (group.blend == Blend::screen) p.alpha = hidden / 3.0f;
    if (group.blend == Blend::add) p.alpha = 0.0f;
    return p;
}

}  // namespace

std::vector<BlendGroup> make_groups(std::span<const RenderLayer> layers, bool aovs) {
    std::vector<BlendGroup> groups;
    BlendGroup merged;
    std::size_t merged_place = 0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const LayerRender& render = layers[i].render;
        if (is_isolated(render)) {
            groups.push_back({{i},
                              FoldKind::general,
                              true,
                              render.blend,
                              render.holdout,
                              layers[i].absorbs,
                              layers[i].splats && layers[i].splats->encoded});
        } else {
            if (merged.layers.empty()) merged_place = groups.size();
            merged.layers.push_back(i);
        }
    }
    if (!merged.layers.empty()) groups.insert(groups.begin() + std::ptrdiff_t(merged_place), merged);
    for (BlendGroup& group : groups) group.kind = kind_of(layers, group.layers, aovs);
    return groups;
}

TileResolver::TileResolver(std::span<const RenderLayer> layers, const RenderSettings& settings)
    : layer_count_(layers.size()), settings_(settings) {}

void TileResolver::begin(const TilePlanes& tile, const Camera& camera, const Environment* environment) {
    const std::size_t size = std::size_t(tile.width) * std::size_t(tile.height);
    pixels_.assign(size, {});
    environment_ = environment || settings_.backdrop;
    if (settings_.aov_layers) light_.assign(size * layer_count_ * 4, 0.0f);
    if (settings_.backdrop) return begin_with_backdrop(tile);
    if (!environment) return;
    const double spread = pixel_spread(camera);
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
            PixelState& pixel = pixels_[y * tile.width + x];
            const double x_px = double(tile.x0 + x) + 0.5, y_px = double(tile.y0 + y) + 0.5;
            if (!shows(camera, x_px, y_px)) {
                pixel.held = 1.0f;
                continue;
            }
            const glm::dvec3 ray = ray_direction(camera, x_px, y_px);
            const glm::vec3 color = sample_environment(*environment, camera.eye, ray, spread);
            for (int k = 0; k < 3; ++k) pixel.color[k] = color[k];
            pixel.alpha = 1.0f;
        }
    }
}

void TileResolver::begin_with_backdrop(const TilePlanes& tile) {
    for (int y = 0; y < tile.height; ++y) {
        const float* color = settings_.backdrop->at(tile.x0, tile.y0 + y);
        for (int x = 0; x < tile.width; ++x) {
            PixelState& pixel = pixels_[y * tile.width + x];
            std::copy_n(color + 4 * x, 3, pixel.color);
            pixel.alpha = 1.0f;
        }
    }
}

void TileResolver::composite(const BlendGroup& group, const TilePlanes& planes) {
    for (int y = 0; y < planes.height; ++y) {
        for (int x = 0; x < planes.width; ++x) {
            const std::size_t i = planes.at(x, y), n = std::size_t(y * planes.width + x);
            PixelState& pixel = pixels_[n];
            GroupPixel p = group_pixel(group, planes, i);
            const bool lighten = group.blend == Blend::lighten && group.isolated && !group.holdout;
            if (lighten)  // the brighter of the two, per channel: the other's light does not arrive
                for (int k = 0; k < 3; ++k) {
                    p.through[k] = p.color[k] > pixel.color[k] ? 0.0f : 1.0f;
                    if (p.through[k] > 0.0f) p.color[k] = 0.0f;
                }
            for (int k = 0; k < 3; ++k) pixel.color[k] = p.color[k] + p.through[k] * pixel.color[k];
            pixel.held = planes.held[i] + p.through[3] * pixel.held;
            pixel.alpha = environment_ ? 1.0f - pixel.held : p.alpha + p.through[3] * pixel.alpha;
            if (settings_.aov_depth || settings_.aov_coverage || settings_.aov_count) {
                pixel.depth_sum = planes.depth_sum[i] + p.through[3] * pixel.depth_sum;
                pixel.depth_weight = planes.alpha[i] + p.through[3] * pixel.depth_weight;
                pixel.uncovered *= planes.uncovered[i];
                pixel.count += planes.count[i];
            }
            if (!settings_.aov_layers) continue;
            float* light = &light_[n * layer_count_ * 4];
            for (std::size_t l = 0; l < layer_count_; ++l)
                for (std::size_t k = 0; k < 4; ++k) light[4 * l + k] *= p.through[k];
            for (std::size_t l : group.layers) {
                for (std::size_t k = 0; k < 4; ++k)
                    light[4 * l + k] += group.isolated ? (k < 3           ? p.color[k]
                                                          : group.holdout ? 0.0f
                                                                          : p.alpha)
                                                       : planes.layer_light[4 * l + k][i];
            }
        }
    }
}

void TileResolver::write(const TilePlanes& tile, std::int64_t x0, std::int64_t y0,
                         RenderedFrame& frame) const {
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
            const std::size_t n = std::size_t(y * tile.width + x);
            const PixelState& pixel = pixels_[n];
            const std::int64_t px = tile.x0 - x0 + x, py = tile.y0 - y0 + y;
            float* out = frame.beauty.at(px, py);
            for (int k = 0; k < 3; ++k) out[k] = pixel.color[k];
            out[3] = std::clamp(pixel.alpha, 0.0f, 1.0f);
            if (settings_.aov_depth)
                *frame.depth.at(px, py) =
                    pixel.depth_weight > 0.0f ? pixel.depth_sum / pixel.depth_weight : 0.0f;
            if (settings_.opacity) *frame.opacity.at(px, py) = std::clamp(pixel.depth_weight, 0.0f, 1.0f);
            if (settings_.aov_coverage) *frame.coverage.at(px, py) = 1.0f - pixel.uncovered;
            if (settings_.aov_count) *frame.count.at(px, py) = pixel.count;
            for (std::size_t l = 0; l < frame.layers.size(); ++l)
                for (std::size_t k = 0; k < 4; ++k)
                    frame.layers[l].at(px, py)[k] = light_[(n * layer_count_ + l) * 4 + k];
        }
    }
}

void TileResolver::write_alone(const BlendGroup& group, const TilePlanes& tile, std::int64_t x0,
                               std::int64_t y0, RenderedFrame& frame) const {
    const float *color[3], *through[3];
    for (int k = 0; k < 3; ++k) {
        color[k] = tile.color[k].data();
        through[k] = tile.transmittance[group.kind == FoldKind::over ? 0 : k].data();
    }
    const float *alpha = tile.alpha.data(), *held = tile.held.data();
    for (int y = 0; y < tile.height; ++y) {
        float* out = frame.beauty.at(tile.x0 - x0, tile.y0 - y0 + y);
        const float* behind = settings_.backdrop ? settings_.backdrop->at(tile.x0, tile.y0 + y) : nullptr;
        for (int x = 0; x < tile.width; ++x, out += 4) {
            const std::size_t i = tile.at(x, y);
            for (int k = 0; k < 3; ++k)
                out[k] = behind ? color[k][i] + through[k][i] * behind[4 * x + k] : color[k][i];
            out[3] = std::clamp(behind ? 1.0f - held[i] : alpha[i], 0.0f, 1.0f);
        }
    }
}

}  // namespace astrosplat
