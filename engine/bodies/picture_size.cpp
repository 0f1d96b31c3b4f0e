// Splats are counted on samples: squares spread evenly over the picture are split into bands, and the shares
// of splats that are kept are added up pixel by pixel. Coarse bands differ there from the whole picture's,
// but have few splats.
#include "bodies/bodies.h"

#include <fmt/format.h>

#include <numeric>

#include "bodies/dust.h"
#include "bodies/picture_light.h"
#include "bodies/picture_splats.h"
#include "bodies/placement.h"
#include "bodies/stars.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/real.h"
#include "image/channels.h"
#include "image/resample.h"

namespace astrosplat {
namespace {

constexpr std::int64_t bytes_a_texel = 60;                 // while bodies are made, measured
constexpr std::int64_t bytes_of_dust = 4;                  // the same, where there is dust
constexpr int most_pictures = 255;                         // ids hold 8 bits of their number
constexpr std::int64_t sample_px = 64, margin_px = 16;     // of a sample; around it, for its fine bands
constexpr std::int64_t apart_px = 240, most_samples = 16;  // along a side
constexpr std::int64_t whole_px = 1024;                    // up to which a side is looked at as a whole
constexpr double smallest_px = 64.0;                       // side that no picture is reduced below

// Of a picture that is like `whole`, its part from (x, y) on.
Texture part_of(const Texture& whole, std::int64_t x, std::int64_t y, std::int64_t width,
                std::int64_t height) {
    Texture part;
    part.alpha_from_light = whole.alpha_from_light;
    part.times = whole.times;
    part.image = make_image(width, height, whole.image.channels);
    for (std::int64_t row = 0; row < height; ++row)
        std::copy_n(whole.image.at(x, y + row), width * whole.image.channels, part.image.at(0, row));
    return part;
}

// The sum of value(x, y) over the middle of a part.
template <class Value>
double sum_inside(const Image& part, const Value& value) {
    double sum = 0.0;
    for_each_between(part, margin_px, margin_px, part.width - margin_px - 1, part.height - margin_px - 1,
                     [&](std::int64_t x, std::int64_t y) { sum += double(value(x, y)); });
    return sum;
}

// One that takes the most splats: how thick its disk is, and how it lies if the scene does not say, its
// picture tells.
GalaxyBody thinnest_galaxy(const StructureParams& params) {
    GalaxyBody galaxy;
    galaxy.thickness = least_disk_thickness;
    const bool told = params.galaxies.empty() && params.galaxy.inclination;
    galaxy.cos_i = told ? float(real::cos(real::radians(*params.galaxy.inclination))) : 0.0f;
    return galaxy;
}

struct PixelPlace {
    std::int64_t x, y;
};

// Splats a texel in the middle of a part that begins there in its picture.
double splats_a_texel(const Texture& part, PixelPlace begin, const StructureParams& params,
                      const Placement& placement, const std::vector<Band>& bands) {
    const PictureLight picture = picture_light(part, 0.0);
    const Image brightest = brightest_channel(picture.light);
    Image rest = picture.light;
    take_picture_stars(rest, params, picture.times > 1);
    const Image without_stars = brightest_channel(rest);
    Image emission = make_image(rest.width, rest.height, 3);
    const auto shows = [&](std::int64_t x, std::int64_t y) {
        return picture.alpha.pixels.empty() || *picture.alpha.at(x, y) > 0.0f;
    };
    double splats = 0.0;
    split_bands(std::move(rest), bands, dust_of(params) > 0.0, [&](const Band& band, const Image& light) {
        std::ranges::transform(emission.pixels, light.pixels, emission.pixels.begin(), std::plus());
        const bool coarsest = band.index + 1 == int(bands.size());
        for (const BandSplats& size : band_splats(band, coarsest, placement)) {
            const double kept = sum_inside(brightest, [&](std::int64_t x, std::int64_t y) {
                const float* const p = light.at(x, y);
                const float share = share_of(placement, size, float(begin.x + x), float(begin.y + y));
                return shows(x, y)
                           ? kept_share(share * std::max({p[0], p[1], p[2]}), *brightest.at(x, y), size)
                           : 0.0f;
            });
            splats += kept / double(size.spacing * size.spacing);
        }
    });
    if (dust_of(params) > 0.0) {
        const Image seen = transmittance_of(without_stars, emission, picture.alpha);
        splats += sum_inside(seen, [&](std::int64_t x, std::int64_t y) {
            return expected_dust_splats(*seen.at(x, y), dust_of(params));
        });
    }
    return splats / sum_inside(brightest, [](std::int64_t, std::int64_t) { return 1.0f; });
}

// Where samples of a side begin, and how long they are.
struct Samples {
    std::int64_t count, length, size;
    std::int64_t begin(std::int64_t i) const { return ((2 * i + 1) * size / count - length) / 2; }
};

Samples samples_of(std::int64_t size) {
    if (size <= whole_px) return {1, size, size};
    return {std::min(size / apart_px, most_samples), sample_px + 2 * margin_px, size};
}

}  // namespace

double splats_at_most(std::int64_t width, std::int64_t height, const StructureParams& params) {
    Placement placement = placement_without_fields(width, height, params, 0.0);
    if (params.kind == StructureKind::disk) placement.galaxies.push_back(thinnest_galaxy(params));
    double each_texel = dust_of(params) > 0.0 ? double(expected_dust_splats(0.0f, 1.0)) : 0.0;
    const std::vector<Band> bands = make_bands(width);
    for (const Band& band : bands)
        for (const BandSplats& size : band_splats(band, band.index + 1 == int(bands.size()), placement))
            each_texel += 1.0 / double(size.spacing * size.spacing);
    return each_texel * double(width * height);
}

namespace {

double detail_splats_a_texel(const DetailLevels& levels) {
    // Found: 1.2 to 1.6 and 1.25 to 1.8 for each of its pixels, of the Pillars, the Crab, M101, the Red
    // Spider.
    constexpr double of_one = 1.6, of_two = 1.4;
    return 4.0 * of_one * levels.area_share(1) + 16.0 * of_two * levels.area_share(2);
}

}  // namespace

double expected_splats(const Texture& texture, const StructureParams& params) {
    const Image& image = texture.image;
    if (std::min(image.width, image.height) <= 2 * margin_px) return double(image.width * image.height);
    const Placement placement = placement_to_count(texture, params);
    const std::vector<Band> bands = make_bands(image.width);
    const Samples columns = samples_of(image.width), rows = samples_of(image.height);
    std::vector<double> densities(std::size_t(columns.count * rows.count));
    parallel_each(densities.size(), 1, [&](std::size_t i) {
        const auto number = std::int64_t(i);
        const PixelPlace begin{columns.begin(number % columns.count), rows.begin(number / columns.count)};
        const Texture part = part_of(texture, begin.x, begin.y, columns.length, rows.length);
        densities[i] = splats_a_texel(part, begin, params, placement, bands);
    });
    const double mean = std::accumulate(densities.begin(), densities.end(), 0.0) / double(densities.size());
    return (mean + detail_splats_a_texel(placement.detail)) * double(image.width * image.height);
}

std::vector<PictureOnMesh> pictures_of(std::span<const TexturedMesh> meshes) {
    std::vector<PictureOnMesh> pictures;
    for (std::uint32_t m = 0; m < meshes.size(); ++m)
        for (std::uint32_t i = 0; i < meshes[m].textures.size(); ++i)
            if (meshes[m].textures[i].image.width > 0) pictures.push_back({&meshes[m], m, i});
    if (pictures.size() > most_pictures)
        throw InputError(fmt::format("source.structure: expected at most {} pictures on the meshes, found {}",
                                     most_pictures, pictures.size()));
    return pictures;
}

std::int64_t expected_splats(std::span<const TexturedMesh> meshes, const StructureParams& params) {
    double sum = 0.0;
    for (const PictureOnMesh& mesh : pictures_of(meshes)) sum += expected_splats(mesh.texture(), params);
    return std::int64_t(sum);
}

std::int64_t most_texels_within(std::int64_t bytes) {
    return std::max<std::int64_t>(1, bytes / bytes_a_texel);
}

std::int64_t bodies_memory_bytes(std::span<const TexturedMesh> meshes, const StructureParams& params,
                                 std::int64_t splats) {
    // Measured. What does not grow with the picture is what malloc keeps of reading it and of a sample's
    // bodies, and the ends of blocks: 64 MiB, of 1.9 to 8.6 M texels.
    constexpr std::int64_t bytes_a_splat = 44, bytes_sorted = 84;
    constexpr std::int64_t most_besides = std::int64_t{64} << 20;
    const std::int64_t of_texel = bytes_a_texel + (dust_of(params) > 0.0 ? bytes_of_dust : 0);
    const std::int64_t images = largest_picture(meshes) * of_texel;
    return std::max(images + splats * bytes_a_splat, splats * bytes_sorted) + std::min(most_besides, images);
}

namespace {

// An upper bound of the memory for pictures of their sizes.
std::int64_t most_bytes(std::span<const TexturedMesh> meshes, const StructureParams& params) {
    double splats = 0.0;
    for (const PictureOnMesh& picture : pictures_of(meshes))
        splats += splats_at_most(picture.texture().image.width, picture.texture().image.height, params);
    return bodies_memory_bytes(meshes, params, std::int64_t(splats));
}

// How much of the limit is used; more than 1 is too much.
double used_share(std::span<const TexturedMesh> meshes, const StructureParams& params,
                  const BodiesLimit& limit) {
    const std::int64_t splats = expected_splats(meshes, params);
    const double memory = double(bodies_memory_bytes(meshes, params, splats)) /
                          double(std::max<std::int64_t>(1, limit.room_bytes));
    if (limit.splats <= 0) return memory;
    return std::max(memory, double(splats) / double(limit.splats));
}

Texture* largest_texture(std::vector<TexturedMesh>& meshes) {
    Texture* largest = nullptr;
    for (TexturedMesh& mesh : meshes)
        for (Texture& texture : mesh.textures)
            if (!largest || texels_of(texture) > texels_of(*largest)) largest = &texture;
    return largest;
}

// Before it was reduced as it was read, or enlarged.
ImageSize size_in_file(const Texture& texture) {
    if (texture.file_width > 0) return {texture.file_width, texture.file_height};
    return {texture.image.width / texture.times, texture.image.height / texture.times};
}

// A picture after reduce_to().
ImageSize size_within(const Texture& texture, std::int64_t most_texels) {
    const bool enlarged_before = texture.times > 1;
    const ImageSize whole =
        enlarged_before ? ImageSize{texture.image.width, texture.image.height} : size_in_file(texture);
    if (most_texels <= 0) return whole;
    return size_of_area(whole.width, whole.height, double(most_texels), 1.0);
}

// Reduces one picture until the limit is just kept, as far as this one can do it.
void reduce(Texture& texture, double first_share, const std::function<double()>& share_now) {
    constexpr int most_tries = 8;                     // each of which comes nearer
    constexpr double aimed_at = 0.91, enough = 0.89;  // what is told may be too little by 8 %
    const Image whole = std::move(texture.image);
    double area = double(whole.width * whole.height), share = first_share;
    for (int i = 0; i < most_tries && (share > 1.0 || share < enough); ++i) {
        area = std::min(area * aimed_at / share, double(whole.width * whole.height));
        texture.image = at_area(whole, area, smallest_px);
        share = share_now();
    }
}

}  // namespace

namespace {

// Small pictures become larger by themselves, up to four times.
int times_by_itself(std::int64_t texels) {
    constexpr std::int64_t most_texels = 4 * texels_read_whole;
    constexpr int most_times = 4;
    int times = 1;
    while (times < most_times && texels * (times + 1) * (times + 1) <= most_texels) ++times;
    return times;
}

}  // namespace

void enlarge_small_pictures(std::vector<TexturedMesh>& meshes, const std::string& layer_name) {
    for (TexturedMesh& mesh : meshes) {
        for (Texture& texture : mesh.textures) {
            const std::int64_t texels = texels_of(texture);
            const int times = times_by_itself(texels);
            if (times == 1 || texels == 0 || texture.file_width > 0) continue;
            log_detail(fmt::format("layer '{}': a picture of {}x{} px is enlarged {} times", layer_name,
                                   texture.image.width, texture.image.height, times));
            texture.image = enlarged(texture.image, times);
            texture.times = times;
        }
    }
}

void reduce_pictures(std::vector<TexturedMesh>& meshes, const StructureParams& params,
                     const BodiesLimit& limit, const std::string& layer_name) {
    if (limit.splats <= 0 && most_bytes(meshes, params) <= limit.room_bytes) return;
    const auto share_now = [&] { return used_share(meshes, params, limit); };
    std::vector<const Texture*> reduced;
    for (double share = share_now(); share > 1.0; share = share_now()) {
        Texture* const largest = largest_texture(meshes);
        if (!largest || std::ranges::count(reduced, largest) > 0) return;
        const auto [width, height] = size_in_file(*largest);
        reduce(*largest, share, share_now);
        reduced.push_back(largest);
        // With fewer than 4/5 of the splats that may be, memory was what lacked.
        const bool few = limit.splats <= 0 || expected_splats(meshes, params) < limit.splats * 4 / 5;
        const std::string why =
            few ? fmt::format("would not fit into {} of memory", human_bytes(double(limit.room_bytes)))
                : fmt::format("would be more than {}", human_count(limit.splats, "splat"));
        const std::string message =
            fmt::format("layer '{}': a picture of {}x{} px is reduced to {}x{}, for its bodies {}",
                        layer_name, width, height, largest->image.width, largest->image.height, why);
        if (largest->image.width < width) log_warning(message);  // else it was only enlarged too much
    }
}

void reduce_to(std::vector<TexturedMesh>& meshes, std::int64_t most_texels, const std::string& layer_name) {
    for (TexturedMesh& mesh : meshes) {
        for (Texture& texture : mesh.textures) {
            Image& image = texture.image;
            const ImageSize before = size_in_file(texture), size = size_within(texture, most_texels);
            if (size.width < image.width || size.height < image.height)
                image = reduced_by_area(image, size.width, size.height);
            if (image.width < before.width || image.height < before.height)
                log_detail(fmt::format("layer '{}': a picture of {}x{} px is reduced to {}x{}", layer_name,
                                       before.width, before.height, image.width, image.height));
        }
    }
}

bool have_all_texels(std::span<const TexturedMesh> meshes, std::int64_t most_texels) {
    return std::ranges::all_of(pictures_of(meshes), [&](const PictureOnMesh& picture) {
        const ImageSize size = size_within(picture.texture(), most_texels);
        return picture.texture().image.width >= size.width && picture.texture().image.height >= size.height;
    });
}

std::int64_t largest_picture(std::span<const TexturedMesh> meshes) {
    std::int64_t largest = 0;
    for (const PictureOnMesh& picture : pictures_of(meshes))
        largest = std::max(largest, texels_of(picture.texture()));
    return largest;
}

}  // namespace astrosplat
