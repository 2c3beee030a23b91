! SPDX-License-Identifier: BSD-3-Clause
!> dem from Fortran: docs/fortran.md. Names are those of the C headers in include/dem, which say what each does. This
!> module has beside them (dem_c.f90) what a C header defines itself, and C strings as Fortran's.
module dem
  use dem_c
  implicit none
  public
  private :: c_status_message, c_status_name, c_kernel_name, c_version, c_version_sundials, c_version_hdf5

contains

  !> A copy of a C string; '' if there is none.
  function dem_string(chars) result(text)
    type(c_ptr), intent(in) :: chars
    character(:), allocatable :: text
    character(kind=c_char), pointer :: c(:)
    integer(c_size_t) :: n, k
    interface
      integer(c_size_t) function strlen(chars) bind(c)
        import
        type(c_ptr), value :: chars
      end function
    end interface

    n = 0
    if (c_associated(chars)) n = strlen(chars)
    allocate (character(n) :: text)
    if (n == 0) return
    call c_f_pointer(chars, c, [n])
    do k = 1, n
      text(k:k) = c(k)
    end do
  end function

  !> What the last failure in this thread was.
  function dem_status_message() result(text)
    character(:), allocatable :: text
    text = dem_string(c_status_message())
  end function

  !> '' if there is no such status.
  function dem_status_name(status) result(text)
    integer(dem_status), intent(in) :: status
    character(:), allocatable :: text
    text = dem_string(c_status_name(status))
  end function

  !> '' if there is no such kernel.
  function dem_kernel_name(kind) result(text)
    integer(dem_kernel), intent(in) :: kind
    character(:), allocatable :: text
    text = dem_string(c_kernel_name(kind))
  end function

  function dem_version() result(text)
    character(:), allocatable :: text
    text = dem_string(c_version())
  end function

  function dem_version_sundials() result(text)
    character(:), allocatable :: text
    text = dem_string(c_version_sundials())
  end function

  function dem_version_hdf5() result(text)
    character(:), allocatable :: text
    text = dem_string(c_version_hdf5())
  end function

  pure type(dem_options) function dem_options_default() result(options)
    options%gravity = [0d0, -9.81d0, 0d0]
    options%rtol = 1d-6
    options%max_impacts = 10000
    options%window = -1
    options%vertices = .true.
    options%threads = 1
    options%checkpoint_steps = 256
  end function

  pure type(dem_trajectory_options) function dem_trajectory_options_default() result(options)
    options%deflate = 1
    options%most_stressed = 5
    options%fields = iand(DEM_FIELD_ALL, not(ior(ior(DEM_FIELD_PRINCIPAL, DEM_FIELD_CONTACT), &
      ior(DEM_FIELD_FRAGMENT, DEM_FIELD_DAMAGE))))
  end function

  pure type(dem_lattice) function dem_lattice_empty() result(lattice)
    lattice%dim = 2
  end function

  pure type(dem_slab) function dem_slab_empty() result(slab)
    slab%lattice = dem_lattice_empty()
  end function
end module
