#include "viewer/picture_starts.h"

#include "core/log.h"
#include "output/format.h"
#include "pipeline.h"
#include "scene/scene.h"

namespace astrosplat {

LatestWork<StartRequest, StartMade>::Work start_maker(const SetCache& cache) {
    return [cache](const StartRequest& request, const Progress& stop) {
        const Progress progress{[done = request.done](double share) { *done = float(share); },
                                stop.cancelled};
        StartMade made{request.start, {}, {}};
        made.text = picture_start_text(made.start, request.place, cache, progress);
        return made;
    };
}

void PictureStarts::want(StartRequest request) {
    request.number = ++asked_;
    wanted_ = request;
    work_.want(request);
}

void PictureStarts::cancel() {
    work_.forget();
    wanted_.reset();
}

std::shared_ptr<const StartMade> PictureStarts::take() {
    std::shared_ptr<const StartMade> made = wanted_ ? work_.found(*wanted_) : nullptr;
    if (made) cancel();
    return made;
}

void PictureStarts::keep(const Document& document, const PictureStart& start) {
    constexpr std::size_t most = 64;
    if (kept_.size() >= most) kept_.erase(kept_.begin());
    kept_.push_back({document.began(), start});
}

const PictureStart* PictureStarts::of(const Document& document) const {
    const std::shared_ptr<const std::string> began = document.began();
    const auto kept = std::ranges::find(kept_, began, &Kept::text);
    return began && kept != kept_.end() ? &kept->start : nullptr;
}

KindView kind_view(const KindKey& key, const Progress& progress) {
    const QuietLog quiet;  // nobody has asked for it
    const Scene scene = scene_from_aside(key.picture, key.object, progress);
    Pipeline pipeline(scene, progress.silent());
    const RenderedFrame frame = pipeline.frame(1.0, render_settings(scene.output), progress.silent());
    FrameFormat format;
    format.kind = FrameKind::png;
    format.depth = OutputParams::Depth::uint8;
    format.alpha = OutputParams::Alpha::none;
    format.view = OutputParams::View::srgb;
    format.exposure = scene.output.exposure;
    const std::vector<std::uint8_t> codes = encode_8bit(format, frame.beauty, 0, 0);
    KindView view{make_image(frame.beauty.width, frame.beauty.height, 4, 1.0f), {}};
    for (std::size_t i = 0; i < codes.size(); ++i)
        view.image.pixels[i / 3 * 4 + i % 3] = float(codes[i]) * (1.0f / 255.0f);
    return view;
}

}  // namespace astrosplat
