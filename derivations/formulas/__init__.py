"""A closed form as a user holds it: its values for numbers and arrays, and rulings on others."""
