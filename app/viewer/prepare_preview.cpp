#include "viewer/prepare_preview.h"

#include <algorithm>
#include <utility>

#include "core/color.h"
#include "core/parallel.h"
#include "source/prepared_picture.h"

namespace astrosplat {
namespace {

// Over black, with the screen's curve.
Image displayed(Image image) {
    parallel_each(image.height, 16, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < image.width; ++x) {
            float* const p = image.at(x, y);
            for (int c = 0; c < 3; ++c)
                p[c] = static_cast<float>(
                    real::linear_to_srgb(static_cast<double>(std::clamp(p[c], 0.0f, 1.0f))));
            p[3] = 1.0f;
        }
    });
    return image;
}

// What changes the size of the picture stays, so that before and after lie on each other.
TextureSettings before_preparation(TextureSettings texture) {
    PrepareParams prepare;
    prepare.align = texture.prepare.align;
    texture.prepare = std::move(prepare);
    return texture;
}

}  // namespace

std::optional<PrepareRequest> prepare_request(const LayerParams& layer, std::uint64_t changes) {
    const SourceParams& source = layer.source;
    if (source.kind != SourceKind::mesh || source.meshes.empty() || source.meshes[0].texture.empty())
        return {};
    TextureSettings texture = source.texture;
    texture.mask.clear();  // these come later
    texture.derive = Derived::none;
    texture.smooth = texture.detail = 0.0;
    return PrepareRequest{source.meshes[0].texture, std::move(texture), changes};
}

PreparedView prepared_view(const PrepareRequest& request, std::int64_t most_px, const Progress& progress) {
    PreparedView view;
    view.files = request.files;
    view.before = displayed(
        prepare_picture(request.files, before_preparation(request.texture), progress, most_px).image);
    PreparedPicture after = prepare_picture(request.files, request.texture, progress, most_px);
    view.after = displayed(std::move(after.image));
    view.stars = static_cast<std::int64_t>(after.stars.size());
    return view;
}

PreparePreview::PreparePreview(std::int64_t most_px)
    : LatestWork([most_px](const PrepareRequest& request, const Progress& progress) {
          return prepared_view(request, most_px, progress);
      }) {}

}  // namespace astrosplat
