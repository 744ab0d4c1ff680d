(** Packings with given fractions for radii. Their values and slopes are those fractions that the exact packings of
    [numeric/] have as Taylor coefficients. *)

From Coq Require Export List.
From Coq Require Import ZArith Reals Lia Lra.
From ForceDiffusion Require Export Certify.
Export ListNotations.

Open Scope R_scope.
Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.

Ltac fraction :=
  unfold change_minus, change_plus, turned, ordered_minus, ordered_plus, response_minus, response_plus,
    tilt_minus, tilt_plus, along_minus, along_plus;
  rewrite ?phi_is;
  match goal with
  | Hr : r ?G = _, Hx : n_x ?G = _, Hy : n_y ?G = _, E : ?rho = _ |- _ =>
      rewrite ?Hr, ?Hx, ?Hy, ?E
  end;
  cbv -[IZR Rplus Rmult Rminus Ropp Rinv Rdiv]; lra.

Ltac prove_packing :=
  intros G rho X Hr Hx Hy E P;
  lazymatch goal with P : packing _ ?M _ _ |- _ =>
    repeat match goal with |- _ /\ _ => split end;
    try (intros F C);
    repeat match goal with |- _ /\ _ => split end;
    lazymatch goal with
    | C : carries _ _ ?load _ |- expands (_ ?F ?i ?j) _ _ =>
        eapply expands_to;
        [lazymatch load with
         | surface _ _ => apply (surface_force _ _ _ _ P _ i j ltac:(site) _ C)
         | bulk _ => apply (bulk_force _ _ _ _ P _ i j ltac:(site) _ C)
         | single ?k ?l ?f => apply (single_force _ M _ _ P _ k l f ltac:(site) ltac:(site) C j); site
         end
        |fraction|fraction]
    | |- expands _ _ _ =>
        eapply expands_to; [expand_with ltac:(fun _ => of_packing P)|fraction|fraction]
    end
  end.
