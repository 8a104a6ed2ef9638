// As in sim/model/stages.h: weaker echoes are none. They would come to single precision's denormal numbers, about which a
// processor is many times as long as about others, and whose logarithms, which time gain would show, differ by device.
const float kLeastEcho = 1e-30;
const float kLeastIntensity = 1e-15;  // whose square is kLeastEcho
