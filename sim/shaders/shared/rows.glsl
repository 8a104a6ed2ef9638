// Lines of many planes, or voxels, may need more work groups than a row of them holds: which group this is among those
// of all rows, and which invocation.
int group_in_rows() { return int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x); }
int invocation_in_rows() { return group_in_rows() * int(gl_WorkGroupSize.x) + int(gl_LocalInvocationID.x); }
