// Inputs from hashes and the engine's own sine, so that every machine measures the same work.
#include "inputs.h"

#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"

namespace astrosplat::bench {
namespace {

constexpr double pi = 3.14159265358979323846;

// Row by row through a lattice, as ids go.
void fill(SplatSet& set, std::size_t i, std::size_t side) {
    const auto k = std::uint32_t(i);
    const glm::vec3 cell(float(i % side), float(i / side % side), float(i / side / side));
    const glm::vec3 jitter(random(k, 101), random(k, 102), random(k, 103));
    set.position[i] = (cell + jitter) * (10.0f / float(side)) - 5.0f;
    set.color[i] = {random(k, 104), random(k, 105), random(k, 106)};
    set.alpha[i] = 0.05f + 0.9f * random(k, 107);
    set.distance[i] = 0.2f * random(k, 108);
    set.id[i] = 13 * i + k % 7;
    set.uv[i] = {random(k, 109), random(k, 110)};
    set.normal[i] = {0.0f, 1.0f, 0.0f};
    set.mesh[i] = k % 2;
}

// Longitude and latitude, both from 0 to 1, to a point of the ball.
glm::vec3 ball_point(double u, double v) {
    const double turn = 2.0 * pi * u, up = pi * v;
    const double radius = 5.0 + 0.6 * real::sin(5.0 * turn) * real::sin(up) * real::sin(4.0 * up);
    return glm::vec3(
        glm::dvec3(real::cos(turn) * real::sin(up), -real::cos(up), -real::sin(turn) * real::sin(up)) *
        radius);
}

TexturedMesh textured(Mesh mesh, Image image) {
    TexturedMesh m;
    m.mesh = std::move(mesh);
    m.textures.emplace_back();
    m.textures[0].image = std::move(image);
    return m;
}

}  // namespace

float random(std::uint32_t n, std::uint32_t purpose) {
    return shared::as_uniform(shared::as_hash(1u, n, 0u, purpose));
}

SplatSet random_set(std::int64_t count) {
    SplatSet set;
    const auto n = std::size_t(count);
    set.position.resize(n);
    set.color.resize(n);
    set.alpha.resize(n);
    set.distance.resize(n);
    set.id.resize(n);
    set.uv.resize(n);
    set.normal.resize(n);
    set.mesh.resize(n);
    const auto side = std::size_t(std::ceil(std::cbrt(double(count))));
    parallel_chunks(count, 1 << 16, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin; i < end; ++i) fill(set, std::size_t(i), side);
    });
    set.spacing = glm::dvec3(0.02);
    set.max_distance = 0.2;
    set.generated = true;
    return set;
}

ShadedSplats spread(std::int64_t count, float diameter_px, float alpha, float share) {
    ShadedSplats set;
    const auto n = std::size_t(count);
    set.position.resize(n);
    set.color.resize(n);
    set.alpha.resize(n);
    set.radius.resize(n);
    set.id.resize(n);
    parallel_each(n, 1 << 16, [&](std::size_t i) {
        const auto k = std::uint32_t(i);
        const float z = 10.0f + 10.0f * random(k, 3), part = k % 10 != 0 ? share : 1.0f;
        set.position[i] = {(random(k, 1) - 0.5f) * 1.92f * z * part, (random(k, 2) - 0.5f) * 1.08f * z * part,
                           -z};
        set.radius[i] = 0.5f * diameter_px * z * 0.001f;
        set.alpha[i] = alpha * (0.5f + random(k, 4));
        set.color[i] = {random(k, 5), random(k, 6), random(k, 7)};
        set.id[i] = i;
    });
    return set;
}

Image picture(std::int64_t size) {
    Image image = make_image(size, size, 4);
    parallel_for(size, [&](std::int64_t y, int) {
        for (std::int64_t x = 0; x < size; ++x) {
            const auto s = float(x) / float(size);
            const auto t = float(y) / float(size);
            const float alpha = s < 0.5f ? 1.0f : 1.1f - s;
            float* p = image.at(x, y);
            p[0] = alpha * s * t;
            p[1] = alpha * (1.0f - s) * t;
            p[2] = alpha * (1.0f - t);
            p[3] = alpha;
        }
    });
    return image;
}

TexturedMesh dented_ball(int rings, int segments) {
    Mesh mesh;
    for (int ring = 0; ring <= rings; ++ring)
        for (int segment = 0; segment <= segments; ++segment) {
            const double u = double(segment) / segments, v = double(ring) / rings;
            mesh.positions.push_back(ball_point(segment == segments ? 0.0 : u, v));
            mesh.uvs.emplace_back(float(u), float(v));
        }
    const auto corner = [&](int ring, int segment) { return std::uint32_t(ring * (segments + 1) + segment); };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        mesh.triangles.push_back({{a, b, c}, {a, b, c}});
    };
    for (int ring = 0; ring < rings; ++ring)
        for (int segment = 0; segment < segments; ++segment) {  // one triangle of each quad ends at a pole
            const std::uint32_t a = corner(ring, segment), b = corner(ring, segment + 1),
                                c = corner(ring + 1, segment + 1), d = corner(ring + 1, segment);
            if (ring > 0) add(a, b, c);
            if (ring + 1 < rings) add(a, c, d);
        }
    return textured(std::move(mesh), picture(2048));
}

TexturedMesh plane() {
    Image image = picture(2048);
    for (std::size_t i = 3; i < image.pixels.size(); i += 4) image.pixels[i] = 1.0f;
    return textured(builtin_mesh("plane", 1.0), std::move(image));
}

GenerateInput ball_input(int rings, int segments) {
    GenerateInput input;
    input.max_distance = 0.118;
    input.meshes.push_back(dented_ball(rings, segments));
    SourceParams source;
    source.voxels = glm::i64vec3(406);
    input.lattice = make_lattice(source, input.meshes, input.max_distance);
    return input;
}

GenerateInput plane_input() {
    GenerateInput input;
    input.max_distance = 0.1;
    input.meshes.push_back(plane());
    SourceParams source;
    source.voxels = glm::i64vec3(1000, 30, 1000);
    source.buffer = glm::dvec3(0.0, input.max_distance / 0.4, 0.0);
    input.lattice = make_lattice(source, input.meshes, input.max_distance);
    return input;
}

}  // namespace astrosplat::bench
