// Environment pictures: loading, mip levels and filtered lookup along a direction. Every face is kept with a
// border of one texel taken from its neighbours (round the seam, over the poles, across the cube's edges), so
// that bilinear lookup never shows where a picture ends.
#include "render/environment.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/rotation.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

constexpr int border = 1;  // texels around every stored level

/// A place on a face, in texels of its level without the border: (0, 0) is the upper left corner.
struct Place {
    std::size_t face;
    double x, y;
};

std::int64_t inner(std::int64_t stored) { return stored - 2 * border; }

Place cube_place(const glm::dvec3& d, double size) {
    glm::dvec3 a = glm::abs(d);
    std::size_t axis = a.x >= a.y && a.x >= a.z ? 0 : (a.y >= a.z ? 1 : 2);
    double along = axis == 0 ? d.x : (axis == 1 ? d.y : d.z);
    std::size_t face = 2 * axis + (along < 0.0 ? 1 : 0);
    const CubeAxes& axes = cube_axes[face];
    double scale = 0.5 / std::fabs(along);
    return {face, (0.5 + glm::dot(axes.right, d) * scale) * size,
            (0.5 - glm::dot(axes.up, d) * scale) * size};
}

glm::vec3 texel(const Image& level, std::int64_t x, std::int64_t y) {
    const float* p = level.at(x + border, y + border);
    return {p[0], p[1], p[2]};
}

void set_texel(Image& level, std::int64_t x, std::int64_t y, const glm::vec3& color) {
    float* p = level.at(x + border, y + border);
    p[0] = color.r, p[1] = color.g, p[2] = color.b;
}

// x, y in [0, inner size]; texel centres at halves.
glm::vec3 bilinear(const Image& level, double x, double y) {
    double fx = std::floor(x - 0.5), fy = std::floor(y - 0.5);
    auto u = float(x - 0.5 - fx), v = float(y - 0.5 - fy);
    auto ix = std::clamp<std::int64_t>(std::int64_t(fx), -border, inner(level.width) - 1);
    auto iy = std::clamp<std::int64_t>(std::int64_t(fy), -border, inner(level.height) - 1);
    glm::vec3 top = texel(level, ix, iy) * (1.0f - u) + texel(level, ix + 1, iy) * u;
    glm::vec3 bottom = texel(level, ix, iy + 1) * (1.0f - u) + texel(level, ix + 1, iy + 1) * u;
    return top * (1.0f - v) + bottom * v;
}

// Round the seam in x; beyond a pole the picture goes on at the opposite longitude.
void fill_latlong_border(Image& level) {
    std::int64_t w = inner(level.width), h = inner(level.height);
    for (std::int64_t x = 0; x < w; ++x) {
        std::int64_t opposite = (x + w / 2) % w;
        set_texel(level, x, -1, texel(level, opposite, 0));
        set_texel(level, x, h, texel(level, opposite, h - 1));
    }
    for (std::int64_t y = -1; y <= h; ++y) {
        set_texel(level, -1, y, texel(level, w - 1, y));
        set_texel(level, w, y, texel(level, 0, y));
    }
}

// A border texel is the nearest inner texel of the face its direction meets; a corner, where three faces
// meet, is the mean of the three texels there.
void fill_cube_border(std::array<Image*, 6> level) {
    std::int64_t n = inner(level[0]->width);
    auto size = double(n);
    auto neighbour = [&](std::size_t face, std::int64_t x, std::int64_t y) {
        const CubeAxes& axes = cube_axes[face];
        double s = (double(x) + 0.5) / size * 2.0 - 1.0, t = 1.0 - (double(y) + 0.5) / size * 2.0;
        Place place = cube_place(glm::normalize(axes.forward + axes.right * s + axes.up * t), size);
        auto at = [n](double c) { return std::clamp<std::int64_t>(std::int64_t(std::floor(c)), 0, n - 1); };
        return texel(*level[place.face], at(place.x), at(place.y));
    };
    for (std::size_t face = 0; face < 6; ++face) {
        Image& image = *level[face];
        for (std::int64_t k = 0; k < n; ++k) {
            set_texel(image, k, -1, neighbour(face, k, -1));
            set_texel(image, k, n, neighbour(face, k, n));
            set_texel(image, -1, k, neighbour(face, -1, k));
            set_texel(image, n, k, neighbour(face, n, k));
        }
        for (std::int64_t y : {std::int64_t{-1}, n})
            for (std::int64_t x : {std::int64_t{-1}, n}) {
                std::int64_t ix = std::clamp<std::int64_t>(x, 0, n - 1),
                             iy = std::clamp<std::int64_t>(y, 0, n - 1);
                set_texel(image, x, y,
                          (texel(image, ix, iy) + texel(image, x, iy) + texel(image, ix, y)) / 3.0f);
            }
    }
}

// The share that each texel of one size has in those of half the size, along one axis: of up to three from
// `first` on.
struct Halving {
    std::int64_t first;
    std::array<double, 3> shares;
};
std::vector<Halving> halvings(std::int64_t size, std::int64_t half) {
    const double rate = double(size) / double(half);
    std::vector<Halving> result(half);
    for (std::int64_t to = 0; to < half; ++to) {
        Halving& halving = result[to];
        halving.first = std::int64_t(rate * double(to));
        for (int k = 0; k < 3; ++k) {
            const auto from = double(halving.first + k);
            const double lo = std::fmax(rate * double(to), from);
            const double hi = std::fmin(rate * double(to + 1), from + 1.0);
            halving.shares[k] = std::fmax(hi - lo, 0.0) / rate;
        }
    }
    return result;
}

// Half the size (rounded up), each texel the mean of the area it covers.
Image half_size(const Image& image) {
    const std::int64_t w = inner(image.width), h = inner(image.height);
    const std::int64_t half_w = (w + 1) / 2, half_h = (h + 1) / 2;
    const std::vector<Halving> columns = halvings(w, half_w), rows = halvings(h, half_h);
    Image result = unfilled_image(half_w + 2 * border, half_h + 2 * border, 3);
    parallel_for(half_h, [&](std::int64_t y, int) {
        const Halving& row = rows[y];
        const auto high = int(std::min<std::int64_t>(3, h - row.first));
        for (std::int64_t x = 0; x < half_w; ++x) {
            const Halving& column = columns[x];
            const auto wide = int(std::min<std::int64_t>(3, w - column.first));
            glm::dvec3 sum(0.0);
            for (int j = 0; j < high; ++j) {
                const float* p = image.at(column.first + border, row.first + j + border);
                for (int i = 0; i < wide; ++i, p += 3)
                    sum += glm::dvec3(p[0], p[1], p[2]) * (column.shares[i] * row.shares[j]);
            }
            set_texel(result, x, y, glm::vec3(sum));
        }
    });
    return result;
}

// A sky's face, RGB, with room for the border.
Image with_border(const Image& picture) {
    std::int64_t texels = (picture.width + 2 * border) * (picture.height + 2 * border);
    claim_memory(texels * 3 * std::int64_t(sizeof(float)) * 4 / 3, "environment picture and its mip levels");
    Image result = unfilled_image(picture.width + 2 * border, picture.height + 2 * border, 3);
    for (std::int64_t y = 0; y < picture.height; ++y)
        std::copy_n(picture.at(0, y), 3 * picture.width, result.at(border, y + border));
    return result;
}

// Of all texels but the border's; no less than 0.
float largest_value(const Image& image) {
    std::vector<float> largest(std::size_t(inner(image.height)), 0.0f);
    parallel_for(inner(image.height), [&](std::int64_t y, int) {
        const float* const row = image.at(border, y + border);
        float& here = largest[y];
        for (std::int64_t i = 0; i < 3 * inner(image.width); ++i) here = here < row[i] ? row[i] : here;
    });
    return largest.empty() ? 0.0f : *std::ranges::max_element(largest);
}

void fill_borders(std::vector<std::vector<Image>>& faces, std::size_t level) {
    if (faces.size() == 1) return fill_latlong_border(faces[0][level]);
    std::array<Image*, 6> images{};
    for (std::size_t face = 0; face < 6; ++face) images[face] = &faces[face][level];
    fill_cube_border(images);
}

void build_levels(std::vector<std::vector<Image>>& faces, const Progress& progress) {
    fill_borders(faces, 0);
    for (std::size_t level = 0; inner(faces[0][level].width) > 1 || inner(faces[0][level].height) > 1;
         ++level) {
        progress.check();
        for (std::vector<Image>& face : faces) face.push_back(half_size(face[level]));
        fill_borders(faces, level + 1);
    }
}

void check_cube(const std::vector<fs::path>& files, const std::vector<std::vector<Image>>& faces) {
    std::int64_t n = inner(faces[0][0].width);
    for (std::size_t face = 0; face < 6; ++face) {
        std::int64_t w = inner(faces[face][0].width), h = inner(faces[face][0].height);
        if (w != n || h != n)
            bad_input(files[face], "environment.cube",
                      fmt::format("{} x {} pixels, as the first picture's width", n, n),
                      fmt::format("{} x {}", w, h));
    }
}

glm::vec3 sample_level(const std::vector<std::vector<Image>>& faces, std::size_t level, const glm::dvec3& d) {
    const Image& first = faces[0][level];
    auto w = double(inner(first.width)), h = double(inner(first.height));
    if (faces.size() == 1) {
        glm::dvec2 place = latlong_place(d);
        return bilinear(first, place.x * w, place.y * h);
    }
    Place place = cube_place(d, w);
    return bilinear(faces[place.face][level], place.x, place.y);
}

// Texels of level 0 per `spread` radians: along the equator of a latlong, at the centre of a cube's face.
double texels_per_spread(const Environment& environment, double spread) {
    const Image& first = (*environment.faces)[0][0];
    auto w = double(inner(first.width)), h = double(inner(first.height));
    return spread *
           (environment.faces->size() == 1 ? std::fmax(w / (2.0 * real::pi), h / real::pi) : 0.5 * w);
}

}  // namespace

Environment load_environment(const EnvironmentParams& params, const Progress& progress,
                             const SkyMaker& make_sky) {
    if (!params.cube.empty() && params.cube.size() != 6)
        throw InputError(
            fmt::format("environment.cube: expected six pictures of the faces of a cube, in the order +x -x "
                        "+y -y +z -z, found {}",
                        params.cube.size()));
    if (!params.cube.empty() + !params.image.empty() + !params.tile.empty() > 1)
        throw InputError("environment: expected image, cube or tile, found several of them");
    std::vector<fs::path> files = params.cube;
    if (files.empty() && !params.image.empty()) files.push_back(params.image);
    Environment environment;
    EnvironmentFaces faces;
    for (const fs::path& file : files) {
        std::vector<Image> pictures = load_environment_pictures(file, border, progress);
        if (files.size() == 6 && pictures.size() != 1)
            bad_input(file, "environment.cube", "a picture of one face",
                      "a cube map, which environment.image takes");
        for (Image& picture : pictures) faces.emplace_back().push_back(std::move(picture));
    }
    if (!params.tile.empty())
        for (const Image& face : make_sky(params.tile, params.tiling, progress))
            faces.emplace_back().push_back(with_border(face));
    for (const std::vector<Image>& face : faces)
        environment.largest_texel = std::max(environment.largest_texel, largest_value(face[0]));
    if (files.size() == 6) check_cube(files, faces);
    if (!faces.empty()) build_levels(faces, progress);
    environment.faces = std::make_shared<const EnvironmentFaces>(std::move(faces));
    set_environment_params(environment, params);
    return environment;
}

EnvironmentParams pictures_of(const EnvironmentParams& params) {
    EnvironmentParams pictures;
    pictures.image = params.image;
    pictures.cube = params.cube;
    pictures.tile = params.tile;
    if (!params.tile.empty()) pictures.tiling = params.tiling;
    return pictures;
}

void set_environment_params(Environment& environment, const EnvironmentParams& params) {
    environment.behind = params.behind;
    environment.environment_from_world = glm::transpose(rotation_from_degrees(params.rotation));
    environment.gain = params.gain;
    environment.largest = environment.largest_texel * params.gain;
}

glm::dvec2 latlong_place(const glm::dvec3& direction) {
    double longitude = real::atan2(direction.x, direction.z), latitude = real::asin(direction.y);
    return {0.5 - longitude / (2.0 * real::pi), 0.5 - latitude / real::pi};
}

SeenPlace seen_place(const Environment& environment, const glm::dvec3& eye, const glm::dvec3& ray) {
    if (!(environment.behind > 0.0)) return {ray};
    constexpr double farthest = 0.99;
    glm::dvec3 e = eye / environment.behind;
    const double out = glm::length(e);
    if (out > farthest) e *= farthest / out;
    // |e + t ray| = 1
    const double along = glm::dot(e, ray);
    const double t = std::sqrt(std::fmax(0.0, along * along + 1.0 - glm::dot(e, e))) - along;
    return {glm::normalize(e + t * ray), t};
}

glm::vec3 sample_environment(const Environment& environment, const glm::dvec3& eye, const glm::dvec3& ray,
                             double spread) {
    const SeenPlace place = seen_place(environment, eye, ray);
    return sample_environment(environment, place.direction, spread * place.distance);
}

glm::vec3 sample_environment(const Environment& environment, const glm::dvec3& direction, double spread) {
    const EnvironmentFaces& faces = *environment.faces;
    if (faces.empty()) return glm::vec3(0.0f);
    glm::dvec3 d = environment.environment_from_world * direction;
    double levels = double(faces[0].size() - 1);
    double texels = texels_per_spread(environment, spread);
    double level = texels > 1.0 ? std::fmin(real::log(texels) * (1.0 / real::log(2.0)), levels) : 0.0;
    auto fine = std::size_t(level);
    auto blend = float(level - double(fine));
    glm::vec3 color = sample_level(faces, fine, d);
    if (blend > 0.0f) color = color * (1.0f - blend) + sample_level(faces, fine + 1, d) * blend;
    return color * environment.gain;
}

}  // namespace astrosplat
