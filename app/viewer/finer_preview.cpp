#include "viewer/finer_preview.h"

#include <algorithm>
#include <cmath>

#include "core/clock.h"
#include "look/view_dependent.h"

namespace astrosplat {
namespace {

FinerFound draw_finer(const FinerRequest& request, CpuPreview& preview, const Progress& progress) {
    const auto start = Clock::now();
    RenderSettings frame;
    frame.width = request.cut.width;
    frame.height = request.cut.height;
    frame.pixel_filter = request.pixel_filter;
    std::vector<CutLayer> seen;
    for (std::size_t i = 0; i < request.sources.size(); ++i) {
        const CutSource& source = request.sources[i];
        if (source.merged)
            seen.push_back(
                {source.merged.get(), source.dots.get(),
                 make_projection(request.layers[i], static_cast<std::uint16_t>(i), request.camera, frame)});
    }
    std::vector<ShadedSplats> cut = cut_splats(seen, request.cut);
    progress.check();
    FinerFound found;
    std::vector<PreviewLayer> layers(request.layers.size());
    for (std::size_t i = 0, next = 0; i < layers.size(); ++i) {
        const CutSource& source = request.sources[i];
        layers[i].layer = request.layers[i];
        if (source.merged && is_encoded(layers[i].layer.render)) encode_colors(cut[next]);
        layers[i].layer.splats = source.merged ? &cut[next++] : source.stars.get();
        if (source.merged) layers[i].layer.render.opacity = 1.0f;
        found.shown += layers[i].layer.splats->size();
    }
    found.image =
        preview.draw(layers, request.camera, request.environment.get(), static_cast<int>(request.cut.width),
                     static_cast<int>(request.cut.height), request.pixel_filter, progress);
    found.seconds = seconds_since(start);
    return found;
}

}  // namespace

StepPlan plan_steps(double final_s) {
    constexpr double at_once_s = 0.3, quick_s = 2.5;
    if (0.0 <= final_s && final_s < at_once_s) return {};
    if (0.0 <= final_s && final_s < quick_s) return {1, 0.08};
    return {2, 0.4};
}

double share_of_step(int step) {
    constexpr double shares[] = {0.05, 0.2};
    return step >= 1 && step <= static_cast<int>(std::size(shares)) ? shares[step - 1] : 0.0;
}

std::int64_t dots_of_step(int step, std::int64_t total, std::int64_t shown, double seconds, double most_s) {
    constexpr double least_gain = 1.5;
    double dots = share_of_step(step) * static_cast<double>(total);
    const double most = static_cast<double>(shown) * (most_s > 0.0 && seconds > 0.0 ? most_s / seconds : 1e9);
    dots = std::min(dots, most);
    return dots < least_gain * static_cast<double>(shown) ? 0 : std::llround(dots);
}

FinerPreview::FinerPreview()
    : LatestWork(
          [preview = std::make_shared<CpuPreview>()](const FinerRequest& request, const Progress& progress) {
              return draw_finer(request, *preview, progress);
          }) {}

}  // namespace astrosplat
