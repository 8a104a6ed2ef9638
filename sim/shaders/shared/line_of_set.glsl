// The stages that walk along lines take those of all planes as one set, an invocation each. A set may have more than one
// row of work groups holds.
int line_of_set() {
  return int((gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x);
}
