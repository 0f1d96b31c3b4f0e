#include "scene/front_frame.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/real.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

// Sums over all faces, seen along an axis: gradients of u and of v times the area, and the largest that
// they could be.
struct PictureDirections {
    glm::dvec3 u{0.0}, v{0.0};
    double most = 0.0;
};

glm::dvec3 corner_of(const Mesh& mesh, const Mesh::Triangle& face, std::size_t k) {
    return glm::dvec3(mesh.positions[face.position[k]]);
}

PictureDirections picture_directions(std::span<const TexturedMesh> meshes, int thin) {
    const int x = (thin + 1) % 3, y = (thin + 2) % 3;
    PictureDirections sums;
    for (const TexturedMesh& textured : meshes)
        for (const Mesh::Triangle& face : textured.mesh.triangles) {
            if (face.uv[0] == Mesh::no_uv) continue;
            const glm::dvec3 a = corner_of(textured.mesh, face, 0),
                             ab = corner_of(textured.mesh, face, 1) - a,
                             ac = corner_of(textured.mesh, face, 2) - a;
            const double twice_area = ab[x] * ac[y] - ab[y] * ac[x], sign = twice_area < 0.0 ? -1.0 : 1.0;
            const auto uv = [&](std::size_t k) { return glm::dvec2(textured.mesh.uvs[face.uv[k]]); };
            const glm::dvec2 by_b = uv(1) - uv(0), by_c = uv(2) - uv(0);
            for (int channel = 0; channel < 2; ++channel) {
                glm::dvec3 gradient(0.0);
                gradient[x] = sign * (by_b[channel] * ac[y] - by_c[channel] * ab[y]);
                gradient[y] = sign * (by_c[channel] * ab[x] - by_b[channel] * ac[x]);
                (channel == 0 ? sums.u : sums.v) += gradient;
                sums.most += glm::length(gradient);
            }
        }
    return sums;
}

int thinnest_axis(const glm::dvec3& extent) {
    constexpr double clearly_less = 0.999;  // sides that differ by rounding count as equal
    int thin = 1;
    for (const int axis : {2, 0})
        if (extent[axis] < clearly_less * extent[thin]) thin = axis;
    return thin;
}

// As the planar projections of a picture are seen (source/mesh.h).
void face_viewer(FrontFrame& frame, int thin) {
    const glm::dvec3 x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0), z(0.0, 0.0, 1.0);
    frame.right = thin == 0 ? -z : x;
    frame.up = thin == 1 ? -z : y;
}

// The directions along the box's sides that fit the texture coordinates best; those of the planar
// projections where these do not say, as on closed surfaces.
void turn_upright(FrontFrame& frame, const PictureDirections& picture) {
    const glm::dvec3 x = frame.right, y = frame.up;
    const auto fit = [&](const glm::dvec3& right, const glm::dvec3& up) {
        return glm::dot(picture.u, right) + glm::dot(picture.v, up);
    };
    constexpr double clearly_better = 0.2;  // of the best fit there could be
    double best = fit(x, y) + clearly_better * picture.most;
    for (const glm::dvec3& right : {x, -x, y, -y})
        for (const glm::dvec3& up : {y, -y, x, -x}) {
            if (glm::dot(right, up) != 0.0 || !(fit(right, up) > best)) continue;
            best = fit(right, up);
            frame.right = right;
            frame.up = up;
        }
}

}  // namespace

FrontFrame front_frame(std::span<const TexturedMesh> meshes) {
    Bounds box;
    for (const TexturedMesh& textured : meshes) box.add(bounds(textured.mesh));
    if (box.empty()) throw InputError("expected a mesh with vertices, found none");
    const int thin = thinnest_axis(box.extent());
    FrontFrame frame;
    frame.center = box.center();
    face_viewer(frame, thin);
    turn_upright(frame, picture_directions(meshes, thin));
    frame.toward = glm::cross(frame.right, frame.up);
    frame.width = std::fabs(glm::dot(box.extent(), frame.right));
    frame.height = std::fabs(glm::dot(box.extent(), frame.up));
    if (!(frame.width > 0.0 && frame.height > 0.0))
        throw InputError("expected a mesh with an area to be seen from the front, found a line or a point");
    frame.camera = meshes.front().camera;
    if (frame.camera) frame.height = frame.width / frame.camera->aspect;
    return frame;
}

FrontFrame in_world(const FrontFrame& frame, const RenderLayer& layer) {
    FrontFrame world = frame;
    world.center = layer.to_world(frame.center);
    world.right = layer.world_from_layer * frame.right;
    world.up = layer.world_from_layer * frame.up;
    world.toward = layer.world_from_layer * frame.toward;
    world.width = layer.scale * frame.width;
    world.height = layer.scale * frame.height;
    if (!frame.camera) return world;
    world.camera->eye = layer.to_world(frame.camera->eye);
    world.camera->world_from_camera = layer.world_from_layer * frame.camera->world_from_camera;
    world.camera->near *= layer.scale;
    if (frame.camera->projection == Projection::orthographic) world.camera->focal_px /= layer.scale;
    return world;
}

FrontFrame along_galaxy(FrontFrame frame, const GalaxyParams& galaxy) {
    if (!galaxy.inclination || !galaxy.near_side || !galaxy.center) return frame;
    const double i = real::radians(*galaxy.inclination), near = real::radians(*galaxy.near_side);
    const double c = real::cos(i), s = real::sin(i);
    const glm::dvec3 b = real::cos(near) * frame.right + real::sin(near) * frame.up, d = frame.toward;
    const auto turned = [&](const glm::dvec3& v) {
        const double along_b = glm::dot(v, b), along_d = glm::dot(v, d);
        return v + along_b * ((c - 1.0) * b + s * d) + along_d * ((c - 1.0) * d - s * b);
    };
    frame.center += (galaxy.center->x - 0.5) * frame.width * frame.right +
                    (galaxy.center->y - 0.5) * frame.height * frame.up;
    frame.right = turned(frame.right);
    frame.up = turned(frame.up);
    frame.toward = turned(frame.toward);
    return frame;
}

FrontFrame along_sight(FrontFrame frame, const GalaxyParams& galaxy) {
    frame = along_galaxy(frame, galaxy);
    if (!galaxy.near_side) return frame;
    const double c = real::cos(real::radians(*galaxy.near_side)),
                 s = real::sin(real::radians(*galaxy.near_side));
    const glm::dvec3 right = frame.right;
    frame.right = s * right - c * frame.up;
    frame.up = c * right + s * frame.up;
    return frame;
}

CameraParams judging_camera(const FrontFrame& frame, JudgingView view, double aspect) {
    if (view == JudgingView::front && frame.camera) return params_of(*frame.camera);
    constexpr double distance = 2.0;  // widths
    const double half_root_2 = std::sqrt(0.5), half_root_3 = std::sqrt(0.75);
    const bool upright = view == JudgingView::front || view == JudgingView::above;
    const glm::dvec3 from = upright                       ? frame.toward
                            : view == JudgingView::tilted ? half_root_2 * (frame.toward - frame.up)
                            : view == JudgingView::side   ? 0.5 * frame.toward - half_root_3 * frame.up
                                                          : -frame.up;
    CameraParams camera;
    camera.projection = Projection::orthographic;
    camera.target = frame.center;
    camera.position = frame.center + distance * frame.width * from;
    camera.up = upright ? frame.up : frame.toward;
    camera.height = frame.width / aspect;
    return camera;
}

namespace {

constexpr double widest_px = 65536.0;
constexpr std::int64_t rows_per_band = 64;

// A face as the frame sees it: x to the right and y down in frame widths from its middle,
// z toward the viewer.
struct SeenFace {
    glm::dvec3 a, ab, ac;
    glm::dvec2 uv, uv_ab, uv_ac;
    const Texture* texture;

    double twice_area() const { return ab.x * ac.y - ab.y * ac.x; }
};

// The same through a camera; faces stay flat where nearness is the inverse of depth.
glm::dvec3 seen_through(const Camera& camera, const glm::dvec3& point) {
    const std::optional<PlaceInPicture> place = place_in_picture(camera, point);
    assert(place);  // the face has texture coordinates
    const bool parallel = camera.projection == Projection::orthographic;
    return {place->uv.x - 0.5, (0.5 - place->uv.y) / camera.aspect,
            parallel ? -place->depth : 1.0 / place->depth};
}

glm::dvec3 seen_from_front(const FrontFrame& frame, const glm::vec3& position) {
    if (frame.camera) return seen_through(*frame.camera, glm::dvec3(position));
    const glm::dvec3 p = (glm::dvec3(position) - frame.center) / frame.width;
    return {glm::dot(p, frame.right), -glm::dot(p, frame.up), glm::dot(p, frame.toward)};
}

std::vector<SeenFace> seen_faces(std::span<const TexturedMesh> meshes, const FrontFrame& frame) {
    std::vector<SeenFace> faces;
    for (const TexturedMesh& textured : meshes) {
        const Mesh& mesh = textured.mesh;
        for (const Mesh::Triangle& face : mesh.triangles) {
            if (face.uv[0] == Mesh::no_uv) continue;
            const auto corner = [&](std::size_t k) {
                return seen_from_front(frame, mesh.positions[face.position[k]]);
            };
            const auto uv = [&](std::size_t k) { return glm::dvec2(mesh.uvs[face.uv[k]]); };
            const std::size_t texture = textured.textures.size() == 1 ? 0 : face.material;
            faces.push_back({corner(0), corner(1) - corner(0), corner(2) - corner(0), uv(0), uv(1) - uv(0),
                             uv(2) - uv(0), &textured.textures[texture]});
        }
    }
    return faces;
}

// Texels of the pictures along a frame's width.
double texels_across(const std::vector<SeenFace>& faces) {
    double texels = 0.0, area = 0.0;
    for (const SeenFace& face : faces) {
        const double uv_area = face.uv_ab.x * face.uv_ac.y - face.uv_ab.y * face.uv_ac.x;
        texels += std::fabs(uv_area) * double(face.texture->image.width * face.texture->image.height);
        area += std::fabs(face.twice_area());
    }
    return area > 0.0 ? std::sqrt(texels / area) : 0.0;
}

// One band of the picture with the depth of what it shows.
struct FrontBand {
    Image& picture;
    std::int64_t from, to;                 // rows
    double scale = double(picture.width);  // px per frame width
    std::vector<double> depths =
        std::vector(std::size_t((to - from) * picture.width), -std::numeric_limits<double>::infinity());

    void draw(const SeenFace& face) {
        const double area = face.twice_area();
        if (area == 0.0) return;
        const auto [left, right] = covered(face.a.x, face.ab.x, face.ac.x, picture.width, 0, picture.width);
        const auto [top, bottom] = covered(face.a.y, face.ab.y, face.ac.y, picture.height, from, to);
        for (std::int64_t y = top; y < bottom; ++y)
            for (std::int64_t x = left; x < right; ++x) {
                const double px = place(x, picture.width) - face.a.x,
                             py = place(y, picture.height) - face.a.y;
                const double b = (px * face.ac.y - py * face.ac.x) / area,
                             c = (py * face.ab.x - px * face.ab.y) / area;
                constexpr double rounding = 1e-9;  // no pixel falls between two faces
                if (b < -rounding || c < -rounding || b + c > 1.0 + rounding) continue;
                show(face, b, c, x, y);
            }
    }

    // Of a pixel's centre, in frame widths from the middle.
    double place(std::int64_t i, std::int64_t size) const {
        return (double(i) + 0.5 - 0.5 * double(size)) / scale;
    }

    // Pixels [first, second) of begin .. end that a face with these corners can touch along an axis.
    std::pair<std::int64_t, std::int64_t> covered(double a, double ab, double ac, std::int64_t size,
                                                  std::int64_t begin, std::int64_t end) const {
        const double lo = a + std::min({0.0, ab, ac}), hi = a + std::max({0.0, ab, ac});
        const auto pixel = [&](double at) {
            const double p = at * scale + 0.5 * double(size);
            return std::clamp(p, double(begin), double(end));
        };
        return {std::int64_t(std::floor(pixel(lo - 1e-9))), std::int64_t(std::ceil(pixel(hi + 1e-9)))};
    }

    void show(const SeenFace& face, double b, double c, std::int64_t x, std::int64_t y) {
        const double z = face.a.z + b * face.ab.z + c * face.ac.z;
        double& depth = depths[(y - from) * picture.width + x];
        if (!(z > depth)) return;
        depth = z;
        const TextureSample seen =
            sample(*face.texture, glm::vec2(face.uv + b * face.uv_ab + c * face.uv_ac));
        for (int i = 0; i < 3; ++i) picture.at(x, y)[i] = seen.color[i] * seen.alpha;
    }
};

}  // namespace

Image front_picture(std::span<const TexturedMesh> meshes, const FrontFrame& frame, const Progress& progress) {
    const std::vector<SeenFace> faces = seen_faces(meshes, frame);
    const double across = texels_across(faces);
    if (!(across > 0.0)) throw InputError("expected a picture on faces seen from the front, found none");
    const double down = across * frame.height / frame.width;
    if (std::max(across, down) > widest_px)
        throw InputError(fmt::format("expected a picture of at most {} px, found {:.0f} x {:.0f}", widest_px,
                                     across, down));
    const auto width = std::max<std::int64_t>(1, std::int64_t(across + 0.5));
    const auto height = std::max<std::int64_t>(1, std::int64_t(down + 0.5));
    claim_memory(width * height * 3 * std::int64_t(sizeof(float)), "the picture from the front");
    Image picture = make_image(width, height, 3);
    parallel_chunks(height, rows_per_band, [&](std::int64_t begin, std::int64_t end, int) {
        progress.check();
        FrontBand band{picture, begin, end};
        for (const SeenFace& face : faces) band.draw(face);
    });
    return picture;
}

}  // namespace astrosplat
