#include "source/textured_mesh.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "core/color.h"
#include "core/error.h"
#include "core/real.h"
#include "image/blur.h"
#include "image/channels.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

constexpr double shape_radius = 5.0;
constexpr int outline_pieces = 128;  // about as long as a column of faces is wide

// A shape's outline and the v of its points.
struct Outline {
    std::vector<glm::dvec2> points;
    std::vector<double> v;

    void add(double r, double y, double at) {
        points.emplace_back(r, y);
        v.push_back(at);
    }
};

void append(Mesh& mesh, const Mesh& other) {
    const auto first = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.uvs.insert(mesh.uvs.end(), other.uvs.begin(), other.uvs.end());
    for (Mesh::Triangle triangle : other.triangles) {
        for (std::uint32_t& index : triangle.position) index += first;
        triangle.uv = triangle.position;
        mesh.triangles.push_back(triangle);
    }
}

// From `first` to `last` degrees of latitude + 90, its poles exactly on the axis.
Outline arc(double last_degrees, double height) {
    const int rows = std::max(2, int(std::ceil(64.0 * last_degrees / 180.0)));
    Outline outline;
    for (int j = 0; j <= rows; ++j) {
        const double degrees = last_degrees * j / rows;
        const bool pole = j == 0 || degrees >= 180.0;
        const double t = real::radians(degrees);
        outline.add(pole ? 0.0 : real::sin(t), -height * real::cos(t), degrees / 180.0);
    }
    return outline;
}

Mesh turned(const Outline& outline, double scale) { return revolved(outline.points, outline.v, scale); }

// Points between the given ones so that no piece is much longer than a column is wide.
Outline divided(const std::vector<glm::dvec2>& points) {
    std::vector<double> at(1, 0.0);
    for (std::size_t i = 1; i < points.size(); ++i)
        at.push_back(at.back() + glm::length(points[i] - points[i - 1]));
    Outline outline;
    const double whole = at.back();
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double length = at[i] - at[i - 1];
        if (!(length > 0.0)) continue;
        const int pieces = std::max(1, int(std::ceil(outline_pieces * length / whole)));
        for (int k = 0; k < pieces; ++k) {
            const double share = double(k) / pieces;
            const glm::dvec2 p = points[i - 1] + (points[i] - points[i - 1]) * share;
            outline.add(p.x, p.y, (at[i - 1] + length * share) / whole);
        }
    }
    outline.add(points.back().x, points.back().y, 1.0);
    return outline;
}

Mesh revolution(const ShapeParams& shape) {
    std::vector<glm::dvec2> points(shape.outline.begin(), shape.outline.end());
    if (points.size() < 2)
        bad_input("revolution", "an outline of at least 2 points [r, y]", fmt::format("{}", points.size()));
    if (points.front().y > points.back().y) std::ranges::reverse(points);
    return turned(divided(points), 1.0);
}

Mesh hourglass(const ShapeParams& shape) {
    Outline outline;
    constexpr int rows = 128;
    for (int j = 0; j <= rows; ++j) {
        const double t = real::pi * j / rows;
        const bool pole = j == 0 || j == rows;
        const double lobes = std::fabs(real::sin(2.0 * t)), spheroid = real::sin(t);
        const double r = shape.width * (shape.waist * spheroid + (1.0 - shape.waist) * lobes);
        outline.add(pole ? 0.0 : r, -real::cos(t), double(j) / rows);
    }
    return turned(outline, shape_radius);
}

Mesh shell(const ShapeParams& shape) {
    const Outline sphere = arc(180.0, 1.0);
    Mesh mesh = turned(sphere, shape_radius);
    Mesh inner = turned(sphere, shape_radius * (1.0 - shape.thickness));
    for (Mesh::Triangle& triangle : inner.triangles) std::swap(triangle.position[1], triangle.position[2]);
    append(mesh, inner);
    return mesh;
}

// Radii whose number per length falls as e^(-c r), r = 1 the last.
double nested_radius(int index, int count, double concentration) {
    const double share = double(index + 1) / count;
    if (concentration < 1e-6 || index + 1 == count) return share;
    return -real::log(1.0 - share * (1.0 - real::exp(-concentration))) / concentration;
}

Mesh spheroid(const ShapeParams& shape) {
    const Outline outline = arc(180.0, 1.0 - shape.flattening);
    Mesh mesh;
    for (int i = 0; i < shape.shells; ++i)
        append(mesh, turned(outline, shape_radius * nested_radius(i, shape.shells, shape.concentration)));
    return mesh;
}

Mesh ring(const ShapeParams& shape) {
    constexpr int rows = 64;
    Outline outline;
    for (int j = 0; j <= rows; ++j) {
        const double t = 2.0 * real::pi * (j % rows) / rows;  // the seam is one circle
        outline.add(1.0 - shape.tube - shape.tube * real::cos(t), -shape.tube * real::sin(t),
                    double(j) / rows);
    }
    return turned(outline, shape_radius);
}

struct TurnedShape {
    const char* name;
    Mesh (*make)(const ShapeParams&);
};
constexpr std::array turned_shapes = {
    TurnedShape{"revolution", revolution},
    TurnedShape{"hourglass", hourglass},
    TurnedShape{"shell", shell},
    TurnedShape{"bubble",
                [](const ShapeParams& s) { return turned(arc(180.0 - s.opening, 1.0), shape_radius); }},
    TurnedShape{"spheroid", spheroid},
    TurnedShape{"ring", ring}};

}  // namespace

bool is_turned_shape(const std::string& name) {
    return std::ranges::any_of(turned_shapes, [&](const TurnedShape& shape) { return name == shape.name; });
}

Mesh turned_shape(const std::string& name, const ShapeParams& shape) {
    const auto found =
        std::ranges::find_if(turned_shapes, [&](const TurnedShape& s) { return name == s.name; });
    Mesh mesh = found->make(shape);
    mesh.name = name;
    return mesh;
}

namespace {

constexpr std::int64_t cells = 256;      // along the longer side
constexpr double blur_of_longer = 0.02;  // standard deviation of the smoothing, of the longer side

// One value per grid vertex, columns x rows, row 0 on top.
struct Heights {
    std::int64_t columns, rows;
    std::vector<double> values;

    double& at(std::int64_t x, std::int64_t y) { return values[y * columns + x]; }
};

// A value for each vertex of what the texels of its cell average to.
template <class ValueOf>
Heights sampled(const Texture& texture, std::int64_t columns, std::int64_t rows, const ValueOf& value_of) {
    Texture lookup;
    lookup.image = texture.image;
    lookup.filter = TextureSettings::Filter::area;
    lookup.wrap = TextureSettings::Wrap::clamp;
    const glm::vec2 box(float(texture.image.width) / float(columns - 1),
                        float(texture.image.height) / float(rows - 1));
    Heights heights{columns, rows, std::vector<double>(columns * rows)};
    for (std::int64_t y = 0; y < rows; ++y) {
        for (std::int64_t x = 0; x < columns; ++x) {
            const glm::vec2 uv(float(x) / float(columns - 1), 1.0f - float(y) / float(rows - 1));
            heights.at(x, y) = value_of(sample(lookup, uv, box));
        }
    }
    return heights;
}

// Brightness as the eye sees it: the display value of the luminance.
Heights brightness(const Texture& texture, std::int64_t columns, std::int64_t rows) {
    return sampled(texture, columns, rows, [](const TextureSample& s) {
        const float light = luminance(s.color.x, s.color.y, s.color.z) * s.alpha;
        return real::linear_to_srgb(std::min(light, 1.0f));
    });
}

// One pass of a separable gaussian; the edge values continue outside.
void blur(Heights& heights, double sigma, bool along_x) {
    const auto reach = std::int64_t(std::ceil(3.0 * sigma));
    std::vector<double> weight;
    double total = 0.0;
    for (std::int64_t k = -reach; k <= reach; ++k) {
        weight.push_back(real::exp(-0.5 * double(k * k) / (sigma * sigma)));
        total += weight.back();
    }
    Heights from = heights;
    for (std::int64_t y = 0; y < heights.rows; ++y) {
        for (std::int64_t x = 0; x < heights.columns; ++x) {
            double sum = 0.0;
            for (std::int64_t k = -reach; k <= reach; ++k) {
                const std::int64_t sx = along_x ? std::clamp<std::int64_t>(x + k, 0, heights.columns - 1) : x;
                const std::int64_t sy = along_x ? y : std::clamp<std::int64_t>(y + k, 0, heights.rows - 1);
                sum += weight[k + reach] * from.at(sx, sy);
            }
            heights.at(x, y) = sum / total;
        }
    }
}

// The brightest place is 1, so that `height` means what it says for dark pictures too.
void normalise(Heights& heights) {
    const double most = *std::ranges::max_element(heights.values);
    if (!(most > 0.0)) return;
    for (double& value : heights.values) value /= most;
}

// The grid's corners over a picture of that aspect, `cells_of_longer` along its longer side.
struct Grid {
    double width, depth;  // scene units
    std::int64_t columns, rows;
};

Grid grid_over(const Image& image, std::int64_t cells_of_longer) {
    assert(image.width > 0 && image.height > 0);
    const double aspect = double(image.width) / double(image.height);
    const auto along = [&](double part_of_longer) {
        const double rounded = std::floor(double(cells_of_longer) * part_of_longer + 0.5);
        return std::max<std::int64_t>(1, std::int64_t(rounded)) + 1;
    };
    const double width = aspect >= 1.0 ? 10.0 : 10.0 * aspect;
    return {width, width / aspect, along(std::min(1.0, aspect)), along(std::min(1.0, 1.0 / aspect))};
}

// The plane with every vertex (x, y), row 0 on top, lifted to height(x, y).
template <class Height>
Mesh lifted_plane(const Grid& grid, const Height& height) {
    Mesh mesh;
    for (std::int64_t y = 0; y < grid.rows; ++y) {
        for (std::int64_t x = 0; x < grid.columns; ++x) {
            const double u = double(x) / double(grid.columns - 1);
            const double down = double(y) / double(grid.rows - 1);
            mesh.positions.emplace_back((u - 0.5) * grid.width, height(x, y), (down - 0.5) * grid.depth);
            mesh.uvs.emplace_back(u, 1.0 - down);
        }
    }
    for (std::int64_t y = 0; y + 1 < grid.rows; ++y) {
        for (std::int64_t x = 0; x + 1 < grid.columns; ++x) {
            const auto d = std::uint32_t(y * grid.columns + x), a = std::uint32_t(d + grid.columns);
            mesh.triangles.push_back({{a, a + 1, d + 1}, {a, a + 1, d + 1}, 0});
            mesh.triangles.push_back({{a, d + 1, d}, {a, d + 1, d}, 0});
        }
    }
    return mesh;
}

// A map's depths at every vertex, each averaging the texels of one cell.
Heights map_values(const fs::path& file, const Grid& grid) {
    Texture grey;
    grey.image = made_by_pixel(load_depths(file), 4, [](const float* in, float* out) {
        std::fill_n(out, 3, *in);
        out[3] = 1.0f;
    });
    return sampled(grey, grid.columns, grid.rows, [](const TextureSample& s) { return s.color.x; });
}

// Stretched so that the lowest is 0 and the highest 1; even ground is 1/2.
void stretch(Image& heights) {
    const auto [lowest, highest] = std::ranges::minmax_element(heights.pixels);
    const float lo = *lowest, span = *highest - lo;
    const bool is_even = span <= 1e-5f * std::max(std::fabs(lo), std::fabs(*highest));  // up to rounding
    for (float& value : heights.pixels) value = is_even ? 0.5f : (value - lo) / span;
}

}  // namespace

Mesh relief_mesh(const Texture& texture, double height) {
    const Grid grid = grid_over(texture.image, cells);
    Heights heights = brightness(texture, grid.columns, grid.rows);
    blur(heights, blur_of_longer * cells, true);
    blur(heights, blur_of_longer * cells, false);
    normalise(heights);
    Mesh mesh = lifted_plane(
        grid, [&](std::int64_t x, std::int64_t y) { return heights.at(x, y) * height * grid.width; });
    mesh.name = "relief";
    return mesh;
}

Mesh sheet_mesh(const Texture& texture, const ShapeParams& shape) {
    constexpr std::int64_t sheet_cells = 512;
    const Grid grid = grid_over(texture.image, sheet_cells);
    const Heights raw = shape.depth_map.empty() ? brightness(texture, grid.columns, grid.rows)
                                                : map_values(shape.depth_map, grid);
    Image heights = make_image(grid.columns, grid.rows, 1);
    for (std::size_t i = 0; i < raw.values.size(); ++i) heights.pixels[i] = float(raw.values[i]);
    heights = gaussian_blur(heights, shape.blur * double(sheet_cells));
    stretch(heights);
    Mesh mesh = lifted_plane(grid, [&](std::int64_t x, std::int64_t y) {
        return (double(*heights.at(x, y)) - 0.5) * shape.depth * grid.width;
    });
    mesh.name = "sheet";
    return mesh;
}

}  // namespace astrosplat
