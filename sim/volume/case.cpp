#include "sim/volume/case.h"
