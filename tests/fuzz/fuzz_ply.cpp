// Fuzzes the ply reader; see targets.cpp for what it demands.
#include "fuzz/entry.h"

ASTROSPLAT_FUZZ("ply")
