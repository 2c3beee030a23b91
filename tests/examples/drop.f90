! SPDX-License-Identifier: BSD-3-Clause
! The program of docs/fortran.md: drop.c in Fortran.
program drop
  use dem
  implicit none
  type(dem_material), parameter :: rubber = dem_material(youngs_modulus=1d7, poissons_ratio=1 / 3d0, density=1050, &
    thickness=1, guard=0.02d0)
  real(c_double), target :: slope(2, 2) = reshape([-0.3d0, 0.1d0, 0.3d0, -0.1d0], [2, 2])
  type(dem_trajectory_options) :: frames
  type(dem_body_motion) :: motion
  type(dem_observer) :: observer
  type(dem_lattice) :: lattice
  type(c_ptr) :: model, simulation, file

  frames = dem_trajectory_options_default()
  frames%frame_interval = 1d-3
  call check(dem_lattice_disc(lattice, 0.065d0, 5d-3))
  call check(dem_lattice_assemble(lattice, rubber))
  call dem_lattice_move(lattice, 0d0, [0d0, 0.1d0])
  call check(dem_lattice_launch(lattice, [0d0, -10d0]))
  call check(dem_model_create(model, lattice, [dem_obstacle(n_points=2, points=c_loc(slope))], 1_dem_index))
  call check(dem_simulation_create(simulation, model, dem_options_default()))
  call check(dem_trajectory_create(file, 'drop.vtkhdf'//c_null_char, simulation, frames))
  call check(dem_trajectory_observer(file, observer))
  call check(dem_simulation_observe(simulation, observer))
  call check(dem_simulation_advance(simulation, 20d-3))
  call check(dem_trajectory_finish(file))
  call check(dem_simulation_body(simulation, 0_dem_index, motion))
  print '(g0, a)', motion%velocity(2), ' m/s'
  call dem_trajectory_destroy(file)
  call dem_simulation_destroy(simulation)
  call dem_model_destroy(model)
  call dem_lattice_free(lattice)

contains

  subroutine check(status)
    integer(dem_status), intent(in) :: status
    if (status == DEM_OK) return
    print '(a)', dem_status_message()
    error stop
  end subroutine
end program
