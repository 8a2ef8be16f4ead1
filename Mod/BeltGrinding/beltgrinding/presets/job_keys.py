"""Which key of a job a preset's number is."""

# The job's key for a preset's number, and its value for the number's 1.
JOB_KEYS = {
    "run_width": ("belt_machine.free_run.width_mm", 1.0),
    "free_length": ("belt_machine.free_run.length_mm", 1.0),
    "run_thickness": ("belt_machine.free_run.thickness_mm", 1.0),
    "run_tension": ("belt_machine.free_run.tension_N_per_mm", 1.0),
    "run_modulus": ("belt_machine.free_run.youngs_modulus_MPa", 1.0),
    "run_poissons_ratio": ("belt_machine.free_run.poissons_ratio", 1.0),
    "roller_radius": ("belt_machine.free_run.roller_radius_mm", 1.0),
    "platen_length": ("belt_machine.platen.length_mm", 1.0),
    "diameter": ("belt_machine.wheel.radius_mm", 0.5),
    "width": ("belt_machine.wheel.width_mm", 1.0),
    "rim_thickness": ("belt_machine.compliance.rim_thickness_mm", 1.0),
    "youngs_modulus": ("belt_machine.compliance.youngs_modulus_MPa", 1.0),
    "poissons_ratio": ("belt_machine.compliance.poissons_ratio", 1.0),
    "land_share": ("law.land_share", 1.0),
    "tension": ("belt_machine.compliance.belt_tension_N_per_mm", 1.0),
    "bending_stiffness": ("belt_machine.compliance.belt_bending_N_mm", 1.0),
    "belt_speed": ("belt_machine.belt_speed_m_s", 1.0),
    "heat_limit": ("law.heat_limit_MPa_m_s", 1.0),
    "conductivity": ("heat.conductivity_W_mK", 1.0),
    "heat_capacity": ("heat.heat_capacity_J_kgK", 1.0),
    "density": ("heat.density_kg_m3", 1.0),
    "burn_temperature": ("heat.burn_temperature_C", 1.0),
    "lag": ("belt_machine.force_dynamics.lag_s", 1.0),
    "moving_mass": ("belt_machine.force_dynamics.moving_mass_kg", 1.0),
    "damping": ("belt_machine.force_dynamics.damping_N_s_per_mm", 1.0),
    "speed_limit": ("belt_machine.force_dynamics.speed_limit_mm_s", 1.0),
}
RANGES = {"friction": "heat.friction", "partition": "heat.partition"}  # both ends are the job's
MACHINE_KIND = "belt_machine.kind"
FLAT = {
    "belt_machine.platen.radius_mm": 0.0
}  # what a platen's preset sets besides: all of them are flat
# What a force control's preset sets besides its numbers: what it has no number for is not there.
ACTUATOR = {
    "belt_machine.force_dynamics.model": "actuator",
    "belt_machine.force_dynamics.lag_s": 0.0,
    "belt_machine.force_dynamics.moving_mass_kg": 0.0,
    "belt_machine.force_dynamics.damping_N_s_per_mm": 0.0,
    "belt_machine.force_dynamics.speed_limit_mm_s": 0.0,
}
