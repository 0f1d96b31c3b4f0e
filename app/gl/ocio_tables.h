// What a display transform of a configuration needs in a fragment shader: its text, and its tables as
// textures.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gl/objects.h"
#include "gl/program.h"
#include "ocio/display_transform.h"

namespace astrosplat {

class OcioTables {
  public:
    bool holds(const std::shared_ptr<const DisplayTransform>& transform) const {
        return transform_ == transform;
    }
    /// Uploads the tables of another one, by texture unit `unit`.
    void take(std::shared_ptr<const DisplayTransform> transform, int unit);
    /// GLSL of "vec4 ocio_display(vec4)".
    const std::string& text() const { return text_; }
    /// Texture units from `first` on.
    void name_samplers(const GlProgram& program, int first) const;
    void bind(int first) const;

  private:
    struct Table {
        std::string sampler;
        GLenum target;
        GlTexture texture;
    };
    std::shared_ptr<const DisplayTransform> transform_;
    std::string text_;
    std::vector<Table> tables_;
};

}  // namespace astrosplat
