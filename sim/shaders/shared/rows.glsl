// Lines of many planes, or voxels, may need more work groups than a row of them holds: which invocation this is among
// those of all rows.
int invocation_in_rows() {
  return int((gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x);
}
