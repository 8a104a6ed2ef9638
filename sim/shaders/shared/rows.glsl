// Lines of many planes, or voxels, may need more work groups than one row of a dispatch holds. These return the index
// of the work group, and of the invocation, over all rows.
int group_in_rows() { return int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x); }
int invocation_in_rows() { return group_in_rows() * int(gl_WorkGroupSize.x) + int(gl_LocalInvocationID.x); }
