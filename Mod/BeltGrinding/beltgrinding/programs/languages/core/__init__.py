"""What the readers of robot languages have in common; docs/adding-a-language.md says how one is added."""
