#include "gl/environment_pass.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "core/real.h"
#include "gl/image_texture.h"

namespace astrosplat {
namespace {

constexpr int fine_unit = 0, coarse_unit = 1;

/// Mip level, with its fraction, for pixels `spread` radians apart; as sample_environment.
double level_of(const Environment& environment, double spread) {
    const Image& first = (*environment.faces)[0][0];
    const double w = double(first.width - 2), h = double(first.height - 2);
    const double texels =
        spread * (environment.faces->size() == 1 ? std::fmax(w / (2.0 * real::pi), h / real::pi) : 0.5 * w);
    const auto last = static_cast<double>((*environment.faces)[0].size() - 1);
    return texels > 1.0 ? std::fmin(real::log(texels) / real::log(2.0), last) : 0.0;
}

}  // namespace

void EnvironmentPass::Level::hold(const Environment& environment, std::size_t level) {
    const Image& first = (*environment.faces)[0][level];
    const float found = content_probe(first);
    if (texture.name() != 0 && pixels == first.pixels.data() && probe == found) return;
    pixels = first.pixels.data();
    probe = found;
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture.get());
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGB32F, static_cast<GLsizei>(first.width),
                 static_cast<GLsizei>(first.height), static_cast<GLsizei>(environment.faces->size()), 0,
                 GL_RGB, GL_FLOAT, nullptr);
    for (std::size_t face = 0; face < environment.faces->size(); ++face)
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, static_cast<GLint>(face),
                        static_cast<GLsizei>(first.width), static_cast<GLsizei>(first.height), 1, GL_RGB,
                        GL_FLOAT, (*environment.faces)[face][level].pixels.data());
    set_sampling(GL_TEXTURE_2D_ARRAY, GL_LINEAR);
}

EnvironmentPass::EnvironmentPass() : program_({{}, {"screen_vertex.glsl"}, environment_fragment_files, {}}) {
    program_.set_sampler("fine_level", fine_unit);
    program_.set_sampler("coarse_level", coarse_unit);
}

void EnvironmentPass::draw(const Environment& environment, const Camera& camera) {
    const double level = level_of(environment, pixel_spread(camera));
    const auto fine = static_cast<std::size_t>(level);
    const std::size_t coarse = std::min(fine + 1, (*environment.faces)[0].size() - 1);
    fine_.hold(environment, fine);
    coarse_.hold(environment, coarse);
    bind_texture(fine_unit, GL_TEXTURE_2D_ARRAY, fine_.texture.name());
    bind_texture(coarse_unit, GL_TEXTURE_2D_ARRAY, coarse_.texture.name());
    program_.use();
    const glm::mat3 rotation(environment.environment_from_world);
    glUniformMatrix3fv(program_.uniform("environment_from_world"), 1, GL_FALSE, glm::value_ptr(rotation));
    const glm::vec3 eye(environment.behind > 0.0 ? camera.eye / environment.behind : glm::dvec3(0.0));
    glUniform1i(program_.uniform("is_near"), environment.behind > 0.0);
    glUniform3fv(program_.uniform("eye"), 1, glm::value_ptr(eye));
    const glm::mat3 from_camera(camera.world_from_camera);
    glUniformMatrix3fv(program_.uniform("world_from_camera"), 1, GL_FALSE, glm::value_ptr(from_camera));
    const Lens lens = make_lens(camera);
    glUniform1i(program_.uniform("lens.projection"), lens.projection);
    glUniform1f(program_.uniform("lens.focal_px"), lens.focal_px);
    glUniform1f(program_.uniform("lens.center_x_px"), lens.center_x_px);
    glUniform1f(program_.uniform("lens.center_y_px"), lens.center_y_px);
    glUniform1f(program_.uniform("lens.edge"), lens.edge);
    glUniform1f(program_.uniform("coarse_share"), float(level - double(fine)));
    glUniform1f(program_.uniform("gain"), environment.gain);
    glDisable(GL_BLEND);
    triangle_.draw();
}

}  // namespace astrosplat
