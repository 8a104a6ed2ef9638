// Empty: the target needs a source to precompile its headers with.
