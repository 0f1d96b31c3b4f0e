#include "fuzz/gaussians.h"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/text.h"
#include "fuzz/targets.h"
#include "splat_files/formats.h"
#include "support/capture.h"

namespace astrosplat::fuzz {
namespace {

/// A file of this process that holds the bytes while the object lives.
struct CaptureFile {
    std::filesystem::path path;
    CaptureFile(std::string_view bytes, const std::string& ending)
        : path(std::filesystem::temp_directory_path() /
               ("astrosplat_fuzz_" + std::to_string(::getpid()) + ending)) {
        std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
    ~CaptureFile() { std::filesystem::remove(path); }
};

template <class Vector>
void demand_finite(const Vector& v) {
    for (int k = 0; k < v.length(); ++k) demand(std::isfinite(v[k]), "finite numbers");
}

std::size_t check_capture(const SplatSet& set) {
    const std::size_t size = set.position.size();
    demand(set.color.size() == size && set.alpha.size() == size && set.distance.size() == size &&
               set.id.size() == size && set.scale.size() == set.rotation.size(),
           "arrays of one length");
    demand(set.scale.empty() || (set.scale.size() == size && set.radius.size() == size), "a radius each");
    demand(set.harmonics.empty() || set.harmonics.size() == size, "harmonics each");
    for (std::size_t i = 0; i < set.scale.size(); ++i) {
        demand_finite(set.position[i]);
        demand_finite(set.color[i]);
        demand_finite(set.scale[i]);
        demand(std::isfinite(set.radius[i]), "a finite radius");
        demand(set.alpha[i] >= 0.0f && set.alpha[i] <= 1.0f, "an opacity");
        double length = 0.0;
        for (int k = 0; k < 4; ++k) length += double(set.rotation[i][k]) * set.rotation[i][k];
        demand(std::fabs(length - 1.0) < 1e-5, "rotations of length 1");
    }
    for (const Harmonics& harmonics : set.harmonics)
        for (const glm::vec3& c : harmonics.c) demand_finite(c);
    return size;
}

/// The same as text, with its bytes inside.
std::string text_of_glb(const std::string& glb) {
    const std::size_t binary = glb.find(std::string("BIN\0", 4));
    std::string json = glb.substr(20, binary - 24);
    const std::string buffer = "\"buffers\":[{";
    return json.insert(json.find(buffer) + buffer.size(), "\"uri\":\"data:application/octet-stream;base64," +
                                                              base64(glb.substr(binary + 4)) + "\",");
}

}  // namespace

std::vector<std::string> gaussian_ply_seeds() {
    using namespace astrosplat::test;
    return {ply_of(capture(3, 0), 0), ply_of(capture(2, 1), 1)};
}

std::vector<std::string> gltf_seeds() {
    using namespace astrosplat::test;
    const std::string turned =
        glb_of(capture(2, 1), 1, R"(,"rotation":[0,0.6,0,0.8],"scale":[2,2,2],"translation":[1,2,3])");
    return {glb_of(capture(3, 0), 0), turned, text_of_glb(turned)};
}

std::vector<std::string> usda_seeds() {
    using namespace astrosplat::test;
    return {
        usda_of(capture(3, 0), 0),
        usda_of(capture(2, 1), 1,
                "        quatf xformOp:orient = (0.8, 0, 0.6, 0)\n        float3 xformOp:scale = (2, 2, 2)\n"
                "        uniform token[] xformOpOrder = [\"xformOp:orient\", \"xformOp:scale\"]\n",
                "    upAxis = \"Z\"\n")};
}

std::size_t read_gaussian_ply_bytes(std::string_view bytes) {
    return check_capture(read_ply(CaptureFile(bytes, ".ply").path));
}

std::size_t read_usda_bytes(std::string_view bytes) {
    return check_capture(read_usda_splats(CaptureFile(bytes, ".usda").path));
}

std::size_t read_gltf_bytes(std::string_view bytes) {
    return check_capture(
        read_gltf_splats(CaptureFile(bytes, bytes.starts_with("{") ? ".gltf" : ".glb").path));
}

}  // namespace astrosplat::fuzz
