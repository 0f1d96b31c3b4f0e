// Fuzzes the readers of camera files; see cameras.cpp for what it demands.
#include "fuzz/entry.h"

ASTROSPLAT_FUZZ("cameras")
