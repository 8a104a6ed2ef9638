#include "sim/model/settings.h"
