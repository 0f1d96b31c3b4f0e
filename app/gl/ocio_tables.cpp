// Tables as 32-bit floats: OpenGL interpolates the smooth ones.
#include "gl/ocio_tables.h"

#include <utility>

namespace astrosplat {
namespace {

GLenum target_of(const GlslTable& table) {
    return table.dimensions == 1 ? GL_TEXTURE_1D : table.dimensions == 2 ? GL_TEXTURE_2D : GL_TEXTURE_3D;
}

void upload(GLenum target, const GlslTable& table) {
    const GLint stored = table.channels == 1 ? GL_R32F : GL_RGB32F;
    const GLenum given = table.channels == 1 ? GL_RED : GL_RGB;
    const float* const values = table.values.data();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    if (target == GL_TEXTURE_1D)
        glTexImage1D(target, 0, stored, table.width, 0, given, GL_FLOAT, values);
    else if (target == GL_TEXTURE_2D)
        glTexImage2D(target, 0, stored, table.width, table.height, 0, given, GL_FLOAT, values);
    else
        glTexImage3D(target, 0, stored, table.width, table.width, table.width, 0, given, GL_FLOAT, values);
    set_sampling(target, table.smooth ? GL_LINEAR : GL_NEAREST);
    if (target == GL_TEXTURE_3D) glTexParameteri(target, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
}

}  // namespace

void OcioTables::take(std::shared_ptr<const DisplayTransform> transform, int unit) {
    transform_ = std::move(transform);
    tables_.clear();
    text_.clear();
    if (!transform_) return;
    const GlslTransform glsl = transform_->glsl();
    text_ = glsl.text;
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    for (const GlslTable& table : glsl.tables) {
        tables_.push_back({table.sampler, target_of(table), {}});
        glBindTexture(tables_.back().target, tables_.back().texture.get());
        upload(tables_.back().target, table);
    }
    glActiveTexture(GL_TEXTURE0);
}

void OcioTables::name_samplers(const GlProgram& program, int first) const {
    for (const Table& table : tables_) program.set_sampler(table.sampler.c_str(), first++);
}

void OcioTables::bind(int first) const {
    for (const Table& table : tables_) bind_texture(first++, table.target, table.texture.name());
}

}  // namespace astrosplat
