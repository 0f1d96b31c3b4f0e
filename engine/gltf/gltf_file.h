// The numbers of a glTF file: its JSON, accessors into buffers that lie in it or beside it, and where its
// nodes place what they hold.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "core/standard.h"

namespace astrosplat {

class GltfFile {
  public:
    /// Reads a .gltf or a .glb. Throws InputError.
    explicit GltfFile(const fs::path& file);

    const nlohmann::json& json() const { return json_; }
    const fs::path& path() const { return file_; }

    /// The element `index` of the list `name` at the top. Throws InputError where there is none.
    const nlohmann::json& element(const char* name, const nlohmann::json& index) const;

    /// All numbers of an accessor with so many components, normalised integers as -1..1 or 0..1.
    /// Throws InputError.
    std::vector<float> numbers(const nlohmann::json& accessor, int components);

    /// Throws InputError and nlohmann's exceptions where the file requires extensions that begin otherwise.
    void require_only(std::initializer_list<std::string_view> beginnings) const;

    /// Throws InputError with the file.
    [[noreturn]] void fail(const std::string& expected, const std::string& found) const;

  private:
    const std::string& buffer(const nlohmann::json& index);

    fs::path file_;
    nlohmann::json json_;
    std::string binary_;  // of a .glb
    std::map<std::int64_t, std::string> buffers_;
};

/// How a node places what it holds: a matrix, or a turn (quaternion x y z w), scale and translation.
struct GltfNode {
    std::optional<glm::dmat4> matrix;
    glm::dvec3 translation{0.0}, scale{1.0};
    glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0};

    glm::dmat4 parent_from_node() const;
};

/// Throws InputError and nlohmann's exceptions.
GltfNode node_of(const GltfFile& file, const nlohmann::json& node);

}  // namespace astrosplat
