"""What a result is judged and measured by: verdict, sections, closed mesh, pictures."""
