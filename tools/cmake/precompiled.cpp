// Empty: the target needs a source file to precompile its headers.
