// The numbers of a glTF file: its JSON, and accessors into buffers that lie in it or beside it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace astrosplat {

class GltfFile {
  public:
    /// Reads a .gltf or a .glb. Throws InputError.
    explicit GltfFile(const std::filesystem::path& file);

    const nlohmann::json& json() const { return json_; }
    const std::filesystem::path& path() const { return file_; }

    /// The element `index` of the list `name` at the top. Throws InputError where there is none.
    const nlohmann::json& element(const char* name, const nlohmann::json& index) const;

    /// All numbers of an accessor with so many components, normalised integers as -1..1 or 0..1. Throws
    /// InputError.
    std::vector<float> numbers(const nlohmann::json& accessor, int components);

    [[noreturn]] void fail(const std::string& expected, const std::string& found) const;

  private:
    const std::string& buffer(const nlohmann::json& index);

    std::filesystem::path file_;
    nlohmann::json json_;
    std::string binary_;  // of a .glb
    std::map<std::int64_t, std::string> buffers_;
};

}  // namespace astrosplat
