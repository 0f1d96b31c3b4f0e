// Where a prim of USD stands at a time. In: prims. Out: matrices and numbers, between samples as USD has
// them.
#pragma once

#include <glm/mat4x4.hpp>
#include <set>
#include <span>
#include <string>

#include "usd/usda_stage.h"

namespace astrosplat {

/// An attribute's numbers at a time code: held before its first sample and after its last, linear between
/// neighbours of as many numbers, else held. `fallback` where it has neither value nor samples.
std::vector<double> numbers_at(const UsdPrim& prim, const std::string& name, double time,
                               std::vector<double> fallback);

/// From the last prim's space to the world: each prim is a child of the one before. Column vectors. Throws
/// InputError with `file` where an operation is unknown or has too few numbers.
glm::dmat4 world_from_prim(std::span<const UsdPrim* const> prims, double time, const std::string& file);

/// Adds the time codes at which anything that moves the prim or its lens has a sample.
void add_times(const UsdPrim& prim, std::set<double>& times);

}  // namespace astrosplat
