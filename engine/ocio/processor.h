// OpenColorIO's own types, for the files of this folder alone.
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <filesystem>
#include <string>
#include <vector>

namespace astrosplat {

namespace ocio = OCIO_NAMESPACE;
struct OcioParams;

/// OpenColorIO's messages may have several lines.
std::string one_line(std::string text);

/// Throws InputError.
ocio::ConstConfigRcPtr load_config(const std::filesystem::path& file);

std::vector<std::string> displays_of(const ocio::Config& config);
std::vector<std::string> views_of(const ocio::Config& config, const std::string& display);

/// `wanted`, or the standard where it is empty. Throws OcioError of `key` where it is not one of the known.
std::string chosen(const char* key, const std::string& wanted, const std::string& standard,
                   const std::vector<std::string>& known, const std::filesystem::path& file);

/// Where scene light enters the configuration.
struct LightEntry {
    std::string space;
    bool from_aces = false;  // the space is ACES2065-1
};
/// Throws OcioError.
LightEntry entry_of(const ocio::Config& config, const OcioParams& params, const std::filesystem::path& file);

/// Throws what OpenColorIO throws.
ocio::ConstProcessorRcPtr processor_for(const ocio::Config& config, const LightEntry& entry,
                                        const std::string& display, const std::string& view);

}  // namespace astrosplat
