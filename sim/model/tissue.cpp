#include "sim/model/tissue.h"
