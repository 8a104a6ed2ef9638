#pragma once

#include <hdf5.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <utility>

namespace insonate {

/// Set once a file could not be written. From then on nothing is closed: the library would try to write again what it
/// could not write before, and Debian's ends the process over it.
inline std::atomic<bool> hdf5_given_up = false;

/// An identifier of the HDF5 library, which is closed at the end; below 0 if there is none.
class Hdf5Id {
public:
  using Close = herr_t (*)(hid_t);
  Hdf5Id() = default;
  Hdf5Id(hid_t id, Close how) : id_(id), close_(how) {}
  Hdf5Id(Hdf5Id&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Hdf5Id& operator=(Hdf5Id&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Id() { close(); }
  /// Returns whether it was closed, or there is none.
  bool close() {
    const hid_t id = std::exchange(id_, H5I_INVALID_HID);
    return id < 0 || hdf5_given_up || close_(id) >= 0;
  }
  operator hid_t() const { return id_; }

private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// Begins the use of the library on a thread. It prints each error unless that is switched off, and at the program's
/// end it closes what is open, see hdf5_given_up.
inline void use_hdf5() {
  static const herr_t without_exit_handler = H5dont_atexit();
  (void)without_exit_handler;
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

/// Returns the properties of a file, group or dataset (H5P_..._CREATE) that does not store when it was made: equal
/// content gives equal bytes.
inline Hdf5Id hdf5_without_time(hid_t kind) {
  Hdf5Id properties(H5Pcreate(kind), H5Pclose);
  H5Pset_obj_track_times(properties, false);
  return properties;
}

/// Returns the type of a UTF-8 text of so many bytes.
inline Hdf5Id hdf5_text(std::size_t size) {
  Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(size, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

/// Writes a text as an attribute of a file. Returns whether it could.
inline bool write_hdf5_attribute(hid_t file, const std::string& name, const std::string& text) {
  const Hdf5Id type = hdf5_text(text.size()), space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Id attribute(H5Acreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute >= 0 && H5Awrite(attribute, type, text.empty() ? "\0" : text.c_str()) >= 0;
}

}  // namespace insonate
