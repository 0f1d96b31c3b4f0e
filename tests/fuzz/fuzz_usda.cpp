// Fuzzes the reader of Gaussians in USD; see targets.cpp for what it demands.
#include "fuzz/entry.h"

ASTROSPLAT_FUZZ("usda")
