(** What is said beside the printed Eqs. 10, 12 and 14, and does not depend on how these are printed. *)

From ForceDiffusion Require Import Certify.

Open Scope R_scope.
Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.

(** Besides Eqs. 9 and 10: no other contact below a loaded bead bears a force to first order. *)
Theorem nothing_else_plus (G : lattice) (rho : radii) (M k l i j : Z) (f_load : R) (X : centres) (F : forces) :
  packing G M rho X -> bead M k l -> contact M i j -> (j < l)%Z -> (k - i > l - j \/ i - k >= l - j)%Z ->
  carries M X (single k l f_load) F -> 0 < f_load -> first_order (fun e => f_plus F i j e) (fun e => 0).
Proof. below_load. Qed.

Theorem nothing_else_minus (G : lattice) (rho : radii) (M k l i j : Z) (f_load : R) (X : centres) (F : forces) :
  packing G M rho X -> bead M k l -> contact M i j -> (j < l)%Z -> (i - k > l - j \/ k - i >= l - j)%Z ->
  carries M X (single k l f_load) F -> 0 < f_load -> first_order (fun e => f_minus F i j e) (fun e => 0).
Proof. below_load. Qed.

(** Eq. 12: the variance of one second difference. *)
Theorem one_second_difference (sigma : R) (M W : Z) (L : law W M sigma) (i j : Z) :
  within W M (i - 2) j -> within W M i j -> within W M (i + 2) j ->
  variance L (fun rho => second_difference rho i j 1) = 6 * sigma ^ 2.
Proof. intros A B C. exact (second_difference_variance sigma M W L i j A B C). Qed.

(** Eq. 14: the printed profile is largest at z = 1/6, and only there. *)
Theorem maximum z : z < 1 -> (1 - z) ^ 2 * (4 * z + 1) <= (1 - 1 / 6) ^ 2 * (4 * (1 / 6) + 1) /\
  ((1 - z) ^ 2 * (4 * z + 1) = (1 - 1 / 6) ^ 2 * (4 * (1 / 6) + 1) -> z = 1 / 6).
Proof.
  intros H. assert (E : (1 - 1 / 6) ^ 2 * (4 * (1 / 6) + 1) - (1 - z) ^ 2 * (4 * z + 1) =
    (z - 1 / 6) ^ 2 * (17 / 3 - 4 * z)) by field.
  assert (S : 0 <= (z - 1 / 6) ^ 2) by apply pow2_ge_0. split.
  - assert (0 <= (z - 1 / 6) ^ 2 * (17 / 3 - 4 * z)) by (apply Rmult_le_pos; lra). lra.
  - intros A. rewrite A, Rminus_diag_eq in E by reflexivity. symmetry in E.
    apply Rmult_integral in E. destruct E as [E|E]; [|lra].
    replace ((z - 1 / 6) ^ 2) with (Rsqr (z - 1 / 6)) in E by (unfold Rsqr; ring).
    apply Rsqr_0_uniq in E. lra.
Qed.
