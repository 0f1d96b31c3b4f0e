// A picture is read by rows and made small on the way, so that a large one takes time but no memory.
#include "viewer/small_picture.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/primaries.h"
#include "core/text.h"
#include "image/area.h"
#include "output/read_frame.h"
#include "source/stored_picture.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

/// Values of a FITS plane that are held at once.
constexpr std::int64_t most_values = std::int64_t{1} << 22;

/// What has no value is black: a gap must not take the light around it.
ImageRows without_gaps(ImageRows rows) {
    const std::int64_t row_values = rows.width * rows.channels;
    rows.read = [row_values, read = std::move(rows.read)](std::int64_t begin, std::int64_t end, float* out) {
        read(begin, end, out);
        std::replace_if(
            out, out + (end - begin) * row_values, [](float value) { return std::isnan(value); }, 0.0f);
    };
    return rows;
}

std::int64_t shrunk(std::int64_t length, std::int64_t longer, std::int64_t most_px) {
    return longer <= most_px ? length : std::max<std::int64_t>(1, length * most_px / longer);
}

/// Those that an EXR file names.
std::optional<Chromaticities> chromaticities_of(const fs::path& file) {
    for (const auto& [name, text] : read_image_info(file).metadata) {
        if (name != "chromaticities") continue;
        std::vector<double> n;
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = std::min(text.find(',', begin), text.size());
            n.push_back(parse_double(trim(text.substr(begin, end - begin))).value_or(0.0));
            begin = end + 1;
        }
        if (n.size() != 8 || std::ranges::any_of(n, [](double x) { return !(x > 0.0 && x < 1.0); })) break;
        return Chromaticities{{n[0], n[1]}, {n[2], n[3]}, {n[4], n[5]}, {n[6], n[7]}};
    }
    return std::nullopt;
}

bool is_near(const glm::dvec2& a, const glm::dvec2& b) {
    return std::fabs(a.x - b.x) < 1e-4 && std::fabs(a.y - b.y) < 1e-4;
}

void to_rec709(Image& rgba, const fs::path& file) {
    const std::optional<Chromaticities> from = chromaticities_of(file);
    constexpr Chromaticities to = rec709_chromaticities;
    if (!from || (is_near(from->red, to.red) && is_near(from->green, to.green) &&
                  is_near(from->blue, to.blue) && is_near(from->white, to.white)))
        return;
    const glm::mat3 matrix(primaries_matrix(*from, to));
    for (std::int64_t i = 0; i < rgba.width * rgba.height; ++i) {
        float* const p = rgba.pixels.data() + 4 * i;
        const glm::vec3 light = matrix * glm::vec3(p[0], p[1], p[2]);
        for (int c = 0; c < 3; ++c) p[c] = light[c];
    }
}

}  // namespace

SmallPicture read_small_picture(const fs::path& file, std::int64_t most_px, const Progress& progress) {
    StoredRows from = open_stored(file, TextureSettings{}, progress, most_values);
    SmallPicture made{{}, !from.stored.display_values, from.rows.width, from.rows.height};
    const std::int64_t longer = std::max(made.width, made.height);
    const Image small =
        reduced_by_area(without_gaps(std::move(from.rows)), shrunk(made.width, longer, most_px),
                        shrunk(made.height, longer, most_px));
    progress.check();
    const bool multiplies = small.channels == 4 && !from.stored.picture.associated;
    made.image = make_image(small.width, small.height, 4, 1.0f);
    for (std::int64_t i = 0; i < small.width * small.height; ++i) {
        const float* const p = small.pixels.data() + i * small.channels;
        for (int c = 0; c < 3; ++c) made.image.pixels[4 * i + c] = multiplies ? p[c] * p[3] : p[c];
    }
    if (made.light) to_rec709(made.image, file);
    return made;
}

}  // namespace astrosplat
