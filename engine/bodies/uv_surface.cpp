#include "bodies/uv_surface.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace astrosplat {
namespace {

constexpr int most_cells = 1024;  // a side
constexpr int most_shift = 64;    // pictures that one face may span

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

/// Of a place on the edge itself: whether the face to the edge's left has it.
bool owns(glm::dvec2 a, glm::dvec2 b) { return a.y < b.y || (a.y == b.y && a.x < b.x); }

// The smallest that holds a face, of u and v.
struct UvBox {
    glm::dvec2 lo, hi;
    explicit UvBox(const glm::dvec2 (&uv)[3])
        : lo(glm::min(uv[0], glm::min(uv[1], uv[2]))), hi(glm::max(uv[0], glm::max(uv[1], uv[2]))) {}
};

bool shows(const Mesh::Triangle& triangle, const Mesh& mesh, std::uint32_t material) {
    return (mesh.maps.empty() || triangle.material == material) && triangle.uv[0] != Mesh::no_uv;
}

}  // namespace

UvSurface::UvSurface(const Mesh& mesh, std::uint32_t material, std::int64_t width, std::int64_t height,
                     bool repeats, const Camera* camera)
    : mesh_(mesh), camera_(camera) {
    measure(mesh, material, {double(width), double(height)});
    if (camera) {
        texel_at_depth_1_ = picture_height_at(*camera, 1.0) / double(height);
        for (const glm::vec3& corner : mesh.positions)
            depths_.push_back(glm::dot(camera->world_from_camera[2], camera->eye - glm::dvec3(corner)));
    }
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Mesh::Triangle& triangle = mesh.triangles[i];
        if (!shows(triangle, mesh, material)) continue;
        Face face{{}, i, {}};
        for (int k = 0; k < 3; ++k) face.uv[k] = glm::dvec2(mesh.uvs[triangle.uv[k]]);
        if (!repeats) {
            faces_.push_back(face);
            continue;
        }
        const auto [lo, hi] = UvBox(face.uv);
        const auto first = [](double v) { return int(std::clamp(std::floor(v), -1e6, 1e6)); };
        for (int u = first(lo.x); u <= std::min(first(hi.x), first(lo.x) + most_shift); ++u) {
            for (int v = first(lo.y); v <= std::min(first(hi.y), first(lo.y) + most_shift); ++v) {
                Face shifted = face;
                for (glm::dvec2& corner : shifted.uv) corner -= glm::dvec2(u, v);
                faces_.push_back(shifted);
            }
        }
    }
    for (Face& face : faces_) set_edges(face);
    fill_grid();
}

// From one end to the other in the same order for both faces of an edge, so that a place has the same number
// but for its sign from both.
void UvSurface::set_edges(Face& face) {
    const double whole = cross(face.uv[1] - face.uv[0], face.uv[2] - face.uv[0]);
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2 a = face.uv[(k + 1) % 3], b = face.uv[(k + 2) % 3];
        const bool turned = std::pair(b.x, b.y) < std::pair(a.x, a.y);
        const double sign = whole > 0.0 ? 1.0 : whole < 0.0 ? -1.0 : 0.0;
        face.edges[k] = {turned ? b : a, turned ? a - b : b - a, turned ? -sign : sign,
                         whole > 0.0 ? owns(a, b) : owns(b, a)};
    }
}

void UvSurface::measure(const Mesh& mesh, std::uint32_t material, glm::dvec2 texels) {
    normals_.assign(mesh.positions.size(), glm::vec3(0.0f));
    units_per_texel_.assign(mesh.positions.size(), 0.0f);
    std::vector<double> weights(mesh.positions.size(), 0.0);
    std::vector<glm::dvec3> normals(mesh.positions.size(), glm::dvec3(0.0));
    std::vector<double> scales(mesh.positions.size(), 0.0);
    double area = 0.0, texel_area = 0.0;
    glm::dvec3 total(0.0);
    Bounds box;
    for (const Mesh::Triangle& triangle : mesh.triangles) {
        if (!shows(triangle, mesh, material)) continue;
        glm::dvec3 p[3];
        glm::dvec2 t[3];
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = glm::dvec3(mesh.positions[triangle.position[k]]);
            t[k] = glm::dvec2(mesh.uvs[triangle.uv[k]]) * texels;
            box.add(p[k]);
        }
        const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);  // twice the area long
        const double here = glm::length(normal), there = std::fabs(cross(t[1] - t[0], t[2] - t[0]));
        area += here;
        texel_area += there;
        total += normal;
        for (const std::uint32_t vertex : triangle.position) {
            normals[vertex] += normal;
            scales[vertex] += there > 0.0 ? here * std::sqrt(here / there) : 0.0;
            weights[vertex] += there > 0.0 ? here : 0.0;
        }
    }
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const double length = glm::length(normals[i]);
        if (length > 0.0) normals_[i] = glm::vec3(normals[i] / length);
        if (weights[i] > 0.0) units_per_texel_[i] = float(scales[i] / weights[i]);
    }
    texels_per_unit_ = area > 0.0 ? std::sqrt(texel_area / area) : 0.0;
    const double length = glm::length(total);
    if (!(length > 0.0) || box.empty()) {
        flat_ = false;
        return;
    }
    const double most = 1e-3 * glm::length(box.hi - box.lo);
    const glm::dvec3 up = total / length, middle = 0.5 * (box.lo + box.hi);
    double lo = 1e300, hi = -1e300;
    for (const Mesh::Triangle& triangle : mesh.triangles) {
        for (const std::uint32_t vertex : triangle.position) {
            const double h = glm::dot(glm::dvec3(mesh.positions[vertex]) - middle, up);
            lo = std::min(lo, h);
            hi = std::max(hi, h);
        }
    }
    flat_ = hi - lo <= most;
}

int UvSurface::cell_at(double v) const { return int(std::clamp(v * cells_, 0.0, cells_ - 1.0)); }

template <class Visit>
void UvSurface::for_each_cell(const Face& face, Visit visit) const {
    const auto [lo, hi] = UvBox(face.uv);
    if (!(hi.x >= 0.0 && hi.y >= 0.0 && lo.x <= 1.0 && lo.y <= 1.0)) return;
    for (int y = cell_at(lo.y); y <= cell_at(hi.y); ++y)
        for (int x = cell_at(lo.x); x <= cell_at(hi.x); ++x) visit(std::size_t(y * cells_ + x));
}

void UvSurface::fill_grid() {
    const double side = std::sqrt(double(faces_.size()));
    cells_ = std::clamp(int(side), 1, most_cells);
    first_face_.assign(std::size_t(cells_) * std::size_t(cells_) + 1, 0);
    for (const Face& face : faces_) for_each_cell(face, [&](std::size_t cell) { ++first_face_[cell + 1]; });
    for (std::size_t i = 1; i < first_face_.size(); ++i) first_face_[i] += first_face_[i - 1];
    cell_faces_.resize(first_face_.back());
    std::vector<std::uint32_t> next = first_face_;
    for (std::uint32_t i = 0; i < faces_.size(); ++i)
        for_each_cell(faces_[i], [&](std::size_t cell) { cell_faces_[next[cell]++] = i; });
}

template <class Visit>
void UvSurface::for_each_face_at(glm::vec2 uv, Visit visit) const {
    const glm::dvec2 p(uv);
    const auto here = std::size_t(cell_at(p.y) * cells_ + cell_at(p.x));
    for (std::uint32_t i = first_face_[here]; i < first_face_[here + 1]; ++i) {
        const Face& face = faces_[cell_faces_[i]];
        glm::dvec3 areas;
        const auto is_inside = [&](int k) {
            const Edge& edge = face.edges[k];
            areas[k] = edge.sign * cross(edge.along, p - edge.from);
            return areas[k] > 0.0 || (areas[k] == 0.0 && edge.owned && edge.sign != 0.0);
        };
        if (is_inside(0) && is_inside(1) && is_inside(2)) visit(face, areas / (areas.x + areas.y + areas.z));
    }
}

int UvSurface::faces_at(glm::vec2 uv) const {
    int faces = 0;
    for_each_face_at(uv, [&](const Face&, const glm::dvec3&) { ++faces; });
    return camera_ ? std::min(faces, 1) : faces;
}

void UvSurface::at(glm::vec2 uv, const std::function<void(const SurfacePlace&)>& visit) const {
    std::optional<SurfacePlace> nearest;
    for_each_face_at(uv, [&](const Face& face, const glm::dvec3& weights) {
        if (!camera_) {
            visit(place_on(face, weights));
            return;
        }
        const SurfacePlace place = seen_on(face, weights);
        if (!nearest || place.depth < nearest->depth) nearest = place;
    });
    if (nearest) visit(*nearest);
}

SurfacePlace UvSurface::place_on(const Face& face, const glm::dvec3& weights) const {
    glm::dvec3 position(0.0), normal(0.0);
    double scale = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = mesh_.triangles[face.triangle].position[k];
        const double weight = weights[int(k)];
        position += weight * glm::dvec3(mesh_.positions[vertex]);
        normal += weight * glm::dvec3(normals_[vertex]);
        scale += weight * double(units_per_texel_[vertex]);
    }
    const double length = glm::length(normal);
    SurfacePlace place;
    place.position = glm::vec3(position);
    place.normal = length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0, 1, 0);
    place.units_per_texel = float(scale);
    place.rise = place.normal;
    return place;
}

// The middle between two corners in the picture is nearer to the nearer one of them on the face.
SurfacePlace UvSurface::seen_on(const Face& face, const glm::dvec3& weights) const {
    const bool parallel = camera_->projection == Projection::orthographic;
    const glm::dvec3& back = camera_->world_from_camera[2];
    glm::dvec3 on_face;
    for (int k = 0; k < 3; ++k) {
        const auto vertex = mesh_.triangles[face.triangle].position[k];
        on_face[k] = parallel ? weights[k] : weights[k] / depths_[vertex];
    }
    SurfacePlace place = place_on(face, on_face / (on_face[0] + on_face[1] + on_face[2]));
    const glm::dvec3 to_eye = camera_->eye - glm::dvec3(place.position);
    const double depth = glm::dot(back, to_eye),
                 units_per_texel = parallel ? texel_at_depth_1_ : texel_at_depth_1_ * depth;
    place.depth = float(depth);
    place.units_per_texel = float(units_per_texel);
    place.rise = glm::vec3(parallel ? back : to_eye / depth);
    place.approach = parallel ? 0.0f : float(units_per_texel / depth);
    return place;
}

namespace {

constexpr float nearest = 0.2f;  // to the camera, of the way to it

}  // namespace

float along_rays(const SurfacePlace& place, float z) {
    return z / std::max(nearest, 1.0f + place.approach * z);
}

float along_parallels(const SurfacePlace& place, float z) {
    return z / std::max(nearest, 1.0f - place.approach * z);
}

UvSurface surface_of(const TexturedMesh& mesh, std::uint32_t material) {
    const Texture& texture = mesh.textures[material];
    return {mesh.mesh,
            material,
            texture.image.width,
            texture.image.height,
            texture.wrap == TextureSettings::Wrap::repeat,
            mesh.camera ? &*mesh.camera : nullptr};
}

}  // namespace astrosplat
