! SPDX-License-Identifier: BSD-3-Clause
! Reads every group of a deck with the compiler's own namelist reader: a deck of ours is a Fortran namelist.
module groups
  implicit none
  integer, parameter :: dp = kind(1d0)
  integer :: unit, status
  character(1024) :: message

  abstract interface
    subroutine group_reader()
    end subroutine
  end interface

contains

  subroutine read_run()
    character(4096) :: title
    real(dp) :: t_end, gravity(2), residual
    logical :: pause
    namelist /run/ title, t_end, gravity, residual, pause
    read (unit, nml=run, iostat=status, iomsg=message)
  end subroutine

  subroutine read_material()
    character(4096) :: name, plane, springs, fracture, stress_average
    real(dp) :: youngs_modulus, bond_stiffness, poissons_ratio, density, thickness, guard, damping_time, friction
    real(dp) :: strength, compressive_strength, fracture_energy, critical_stretch, weibull, weibull_volume
    integer(selected_int_kind(18)) :: strength_seed
    namelist /material/ name, youngs_modulus, bond_stiffness, poissons_ratio, plane, density, thickness, guard, &
      damping_time, springs, fracture, strength, compressive_strength, fracture_energy, stress_average, &
      critical_stretch, weibull, weibull_volume, strength_seed, friction
    read (unit, nml=material, iostat=status, iomsg=message)
  end subroutine

  subroutine read_body()
    character(4096) :: shape, lattice, outline, material, disconnected, file, guide
    real(dp), save :: points(20000)
    real(dp) :: size(2), radius, inner_radius, spacing, position(2), angle, clearance, velocity(2), spin, scale, threshold
    real(dp) :: diagonal, jitter, pitch(2), scatter
    integer(selected_int_kind(18)) :: seed, copies(2)
    logical :: invert, rigid
    namelist /body/ shape, size, radius, inner_radius, points, lattice, diagonal, spacing, outline, jitter, seed, &
      material, position, angle, clearance, velocity, spin, rigid, guide, copies, pitch, scatter, disconnected, &
      file, scale, threshold, invert
    read (unit, nml=body, iostat=status, iomsg=message)
  end subroutine

  subroutine read_void()
    integer :: body
    character(4096) :: shape
    real(dp), save :: points(20000)
    real(dp) :: centre(2), radius, inner_radius, size(2), angle
    namelist /void/ body, shape, centre, radius, inner_radius, size, points, angle
    read (unit, nml=void, iostat=status, iomsg=message)
  end subroutine

  subroutine read_pores()
    integer :: body, number
    integer(selected_int_kind(18)) :: seed
    character(4096) :: distribution
    real(dp) :: porosity, radius(2), mean, deviation, wall
    namelist /pores/ body, number, porosity, radius, distribution, mean, deviation, wall, seed
    read (unit, nml=pores, iostat=status, iomsg=message)
  end subroutine

  subroutine read_inclusion()
    integer :: body
    character(4096) :: material, shape
    real(dp), save :: points(20000)
    real(dp) :: centre(2), radius, inner_radius, size(2), angle
    real(dp) :: interface
    namelist /inclusion/ body, material, shape, centre, radius, inner_radius, size, points, angle, interface
    read (unit, nml=inclusion, iostat=status, iomsg=message)
  end subroutine

  subroutine read_weakness()
    integer :: body
    character(4096) :: shape
    real(dp), save :: points(20000)
    real(dp) :: strength, toughness, centre(2), radius, inner_radius, size(2), angle
    namelist /weakness/ body, strength, toughness, shape, centre, radius, inner_radius, size, points, angle
    read (unit, nml=weakness, iostat=status, iomsg=message)
  end subroutine

  subroutine read_crack()
    integer :: body
    real(dp), save :: points(20000)
    namelist /crack/ body, points
    read (unit, nml=crack, iostat=status, iomsg=message)
  end subroutine

  subroutine read_boundary()
    integer :: body, nodes(10000)
    character(4096) :: where, side, kind, components
    real(dp) :: box(4), centre(2), radius, velocity(2), displacement(2), force(2), traction(2), ramp
    namelist /boundary/ body, where, side, box, centre, radius, nodes, kind, components, velocity, displacement, &
      force, traction, ramp
    read (unit, nml=boundary, iostat=status, iomsg=message)
  end subroutine

  subroutine read_obstacle()
    real(dp), save :: points(100000)
    real(dp) :: resolution, roughness, correlation, restitution, friction, velocity(2)
    real(dp) :: amplitude(2), frequency, phase, pivot(2), spin, ramp
    integer(selected_int_kind(18)) :: seed
    character(4096) :: profile, friction_law, motion(3)
    namelist /obstacle/ points, profile, resolution, roughness, correlation, seed, restitution, friction, friction_law, &
      motion, velocity, amplitude, frequency, phase, pivot, spin, ramp
    read (unit, nml=obstacle, iostat=status, iomsg=message)
  end subroutine

  subroutine read_contact()
    character(4096) :: method, bodies, overlap
    real(dp) :: window, thickness, stiffness, friction, penetration_tolerance, rest_speed
    logical :: vertices
    integer :: max_impacts
    namelist /contact/ method, window, vertices, bodies, thickness, stiffness, friction, overlap, &
      penetration_tolerance, rest_speed, max_impacts
    read (unit, nml=contact, iostat=status, iomsg=message)
  end subroutine

  subroutine read_solver()
    character(4096) :: method, kernel
    real(dp) :: rtol, max_step, v_scale, spacing, mass_damping
    integer :: threads, thread_nodes, checkpoint_steps
    namelist /solver/ method, rtol, max_step, v_scale, spacing, mass_damping, kernel, threads, &
      thread_nodes, checkpoint_steps
    read (unit, nml=solver, iostat=status, iomsg=message)
  end subroutine

  subroutine read_output()
    character(4096) :: name, precision
    real(dp) :: frame_interval, history_interval, closure
    character(32) :: fields(9)
    integer :: deflate, peak_every, most_stressed
    logical :: events, breaks, fragments, measure
    namelist /output/ name, frame_interval, history_interval, precision, deflate, events, breaks, fragments, closure, &
      fields, peak_every, most_stressed, measure
    read (unit, nml=output, iostat=status, iomsg=message)
  end subroutine

  subroutine read_probe()
    character(4096) :: name, kind
    real(dp) :: place(4)
    integer :: body, number(2), every
    namelist /probe/ name, kind, place, body, number, every
    read (unit, nml=probe, iostat=status, iomsg=message)
  end subroutine

  !> Number of lines that begin with the group.
  integer function lines_with(group) result(n)
    character(*), intent(in) :: group
    character(4096) :: line
    rewind (unit)
    n = 0
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      line = adjustl(line)
      if (line(:len(group) + 2) == '&'//group//' ') n = n + 1
    end do
  end function

  !> Reads a group as often as it occurs. The compiler calls many faults an end of file: hence the count.
  subroutine read_all(group, read_one)
    character(*), intent(in) :: group
    procedure(group_reader) :: read_one
    integer :: n, expected
    expected = lines_with(group)
    rewind (unit)
    n = 0
    do
      message = ''
      call read_one()
      if (status /= 0) exit
      n = n + 1
    end do
    write (*, '(a, i0, a, i0)') '&'//group//': ', n, ' of ', expected
    if (.not. is_iostat_end(status) .or. n /= expected) then
      write (*, '(a)') trim(message)
      error stop 1
    end if
  end subroutine
end module

program gfortran_reads
  use groups
  implicit none
  character(1024) :: path

  if (command_argument_count() /= 1) error stop 'usage: gfortran_reads DECK'
  call get_command_argument(1, path)
  open (newunit=unit, file=trim(path), status='old', action='read')
  call read_all('run', read_run)
  call read_all('material', read_material)
  call read_all('body', read_body)
  call read_all('void', read_void)
  call read_all('pores', read_pores)
  call read_all('crack', read_crack)
  call read_all('inclusion', read_inclusion)
  call read_all('weakness', read_weakness)
  call read_all('boundary', read_boundary)
  call read_all('obstacle', read_obstacle)
  call read_all('contact', read_contact)
  call read_all('solver', read_solver)
  call read_all('output', read_output)
  call read_all('probe', read_probe)
end program
