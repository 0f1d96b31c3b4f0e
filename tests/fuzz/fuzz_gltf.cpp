// Fuzzes the reader of Gaussians; see targets.cpp for what it demands.
#include "fuzz/entry.h"

ASTROSPLAT_FUZZ("gltf")
