// Fuzzes the readers of star catalogues; see targets.cpp for what it demands.
#include "fuzz/entry.h"

ASTROSPLAT_FUZZ("stars")
