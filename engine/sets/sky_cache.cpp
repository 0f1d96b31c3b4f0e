#include "sets/sky_cache.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "core/sha256.h"
#include "sets/prepared_cache.h"
#include "sets/recipe.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;
using Faces = std::array<Image, 6>;

fs::path sky_file(const SetCache& cache, const std::string& recipe) {
    return cache.folder / (Sha256().add(recipe).hex() + ".exr");
}

Image strip_of(const Faces& faces) {
    Image strip = make_image(faces[0].width, 6 * faces[0].height, 3);
    auto end = strip.pixels.begin();
    for (const Image& face : faces) end = std::copy(face.pixels.begin(), face.pixels.end(), end);
    return strip;
}

/// Nothing where the strip has another size.
std::optional<Faces> faces_of(const Image& strip, std::int64_t side) {
    if (strip.width != side || strip.height != 6 * side) return {};
    Faces faces;
    for (std::int64_t f = 0; f < 6; ++f) {
        Image& face = faces[static_cast<std::size_t>(f)] = make_image(side, side, 3);
        for (std::int64_t y = 0; y < side; ++y)
            for (std::int64_t x = 0; x < side; ++x) std::copy_n(strip.at(x, f * side + y), 3, face.at(x, y));
    }
    return faces;
}

Faces kept_or_made(const SetCache& cache, const fs::path& tile, const SkyTiling& tiling,
                   const Progress& progress) {
    const std::string recipe = cache.folder.empty() ? "" : sky_recipe_text(tile, tiling, progress);
    if (recipe.empty()) return tiled_sky_of(tile, tiling, progress);
    const fs::path file = sky_file(cache, recipe);
    if (const auto kept = read_kept_picture(file, "the sky is made again", progress))
        if (std::optional<Faces> faces = faces_of(kept->image, tiling.face_px)) return std::move(*faces);
    Faces faces = tiled_sky_of(tile, tiling, progress);
    if (sky_recipe_text(tile, tiling, progress) == recipe) keep_picture(cache, file, strip_of(faces), "");
    return faces;
}

}  // namespace

SkyMaker kept_skies(const SetCache& cache) {
    return [cache](const fs::path& tile, const SkyTiling& tiling, const Progress& progress) {
        return kept_or_made(cache, tile, tiling, progress);
    };
}

bool is_kept(const SetCache& cache, const fs::path& tile, const SkyTiling& tiling, const Progress& progress) {
    const std::string recipe = cache.folder.empty() ? "" : sky_recipe_text(tile, tiling, progress);
    std::error_code ignored;
    return !recipe.empty() && fs::is_regular_file(sky_file(cache, recipe), ignored);
}

}  // namespace astrosplat
